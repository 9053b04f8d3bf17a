//! Session logs in, significance out.
