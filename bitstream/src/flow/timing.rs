//! Static timing: how long every path takes, and how much of the period is left.

pub mod delays;
mod graph;
mod report;

pub use graph::{Clock, Graph};
pub use report::{DomainReport, PathStep, Report, TimedPath};
