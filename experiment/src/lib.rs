//! Simulated and real observers: a timed two-interval session and its log.
