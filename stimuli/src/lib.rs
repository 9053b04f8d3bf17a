//! The study file, the manifest of its pictures, and their hashes.
