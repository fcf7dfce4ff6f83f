//! kicker
