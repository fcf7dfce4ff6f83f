//! local_bus
