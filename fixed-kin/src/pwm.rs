//! pwm
