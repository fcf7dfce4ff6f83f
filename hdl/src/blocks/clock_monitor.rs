//! clock_monitor
