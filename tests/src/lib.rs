//! Nothing to link against: this member exists for its test binary.
