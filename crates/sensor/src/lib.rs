//! The sensor description: gel, shell, taxels, read-out, indenters.
