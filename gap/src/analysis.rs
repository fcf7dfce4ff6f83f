//! The whole workflow on one data set.

mod answer;
mod answered;
mod braked;
mod clocks;
mod counts;
mod cut;
mod differing;
mod driven;
mod driving;
mod electrical;
mod filtered;
mod findings;
mod found;
mod gaps;
mod look;
mod look_alikes;
mod measure;
mod misses;
mod moving;
mod order;
mod patterns;
mod question;
mod ratios;
mod resized;
mod robot_file;
mod stale;
mod study;
mod truth;
mod ways;
mod workflow;
mod writing;

use runs::{DataSet, Logs};

use crate::GapError;
use crate::options::{Options, Stage};

use question::Question;
use workflow::Workflow;

pub use crate::limits::Limit;
pub use crate::locate::Located;
pub(crate) use differing::BEGINS;
pub use driven::{Driven, Moment};
pub use found::{Analysis, Leftover, LinkGap, Named, Verdict};
pub use gaps::overall;
pub use robot_file::undo;

/// Analyses a data set in memory.
///
/// # Errors
/// As [`analyse_logs`].
pub fn analyse(set: &DataSet, options: &Options) -> Result<Analysis, GapError> {
    analyse_logs(&Logs::from(set), options)
}

/// Analyses a data set whose logs may be of any length.
///
/// # Errors
/// [`GapError`] if the robot cannot drive, the logs hold nothing that can be compared, or could not be read again.
pub fn analyse_logs(set: &Logs, options: &Options) -> Result<Analysis, GapError> {
    let analysis = analyse_all(set, options);
    match set.logs.iter().find_map(|log| log.failure()) {
        Some(failure) => Err(GapError::Log(failure.clone())),
        None => analysis.map_err(|error| match (error, set.lacking()) {
            (GapError::NothingToCompare, Some(lacking)) => GapError::Lacking(lacking),
            (GapError::NothingToCompare, None) if set.logs.iter().any(|log| !log.camera().is_empty()) => {
                GapError::FewPoses
            }
            (error, _) => error,
        }),
    }
}

fn analyse_all(set: &Logs, options: &Options) -> Result<Analysis, GapError> {
    let mut question = Question::new(set, options)?;
    let mut remarks = set.notes();
    let mut exact = question.exact_links(&mut remarks);
    remarks.extend(question.judge_clocks());
    let (pieces, crossed) = question.cut();
    if pieces.whole.is_empty() {
        return Err(GapError::NothingToCompare);
    }
    remarks.extend(question.judge_poses(pieces.searched(), crossed.as_ref().map(|(active, _)| active)));
    let ways = ways::beyond_frames(&question, pieces.searched(), crossed.as_ref());
    remarks.extend(ways.as_ref().map(|(window_s, ways)| ways::said(*window_s, ways)));
    let whole = question.motion_link(&pieces.whole, ways);
    let sample = pieces.is_sampled().then(|| question.motion_link(pieces.searched(), ways));
    let mut workflow = Workflow::new(&question, &whole, sample.as_ref(), crossed, remarks);
    options.reached(Stage::Exact);
    workflow.counts(&exact);
    workflow.motion();
    workflow.electrical();
    workflow.drive();
    workflow.judge_stamps(&mut exact);
    let replayed = workflow.exact(&exact);
    let written = workflow.written()?;
    workflow.answer(written, exact, replayed)
}
