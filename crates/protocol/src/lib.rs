//! The press protocol: which indenter, where, how deep, how fast.
