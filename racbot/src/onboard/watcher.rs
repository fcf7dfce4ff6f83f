//! A thread that looks at pictures, so that the control loop never waits for one.

use super::Refusals;
use super::frames::Frames;
use driver::drive::PoseSource;
use model::measurement::Measurement;
use model::odometry;
use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::{Glance, OnBoard};

/// Measurements that may wait for the control loop: it takes one a tick, which is faster than any camera.
const WAITING: usize = 4;

/// Beliefs that are kept for pictures that come late: half a second at 1 kHz, more than the filters go back.
const KEPT: usize = 512;

/// What the controller believed, and at which second of the drive.
type Belief = (f64, odometry::Estimate);

/// What the control loop and the camera's thread tell each other.
#[derive(Default)]
struct Shared {
    beliefs: Mutex<VecDeque<Belief>>,
    refuted: AtomicBool,
}

/// The control loop's end.
pub(super) struct Watcher {
    seen: Receiver<Measurement>,
    shared: Arc<Shared>,
}

impl Watcher {
    /// Starts looking; it ends with the pictures, or when this is dropped.
    pub(super) fn start(mut frames: Box<dyn Frames>, lens: Camera, field: Field) -> std::io::Result<(Self, Refusals)> {
        let (sender, seen) = sync_channel(WAITING);
        let beliefs = Mutex::new(VecDeque::with_capacity(KEPT));
        let shared = Arc::new(Shared { beliefs, ..Shared::default() });
        let refusals: Refusals = Arc::new(Mutex::new(BTreeMap::new()));
        let (heard, refused) = (Arc::clone(&shared), Arc::clone(&refusals));
        std::thread::Builder::new().name("on-board camera".to_owned()).spawn(move || {
            let mut onboard = OnBoard::new(lens, field);
            while let Some(frame) = frames.next() {
                // As soon as it is here: detecting takes longer than a tick.
                let predicted = heard.beliefs.lock().ok().and_then(|beliefs| believed_at(&beliefs, lens.latency_s));
                let looked = look(&mut onboard, frame, predicted);
                heard.refuted.store(onboard.refuted(), Ordering::Relaxed);
                match looked {
                    Ok(Some(measured)) if !sent(&sender, measured) => return,
                    Ok(_) => {}
                    Err(why) => {
                        if let Ok(mut refused) = refused.lock() {
                            *refused.entry(why).or_default() += 1;
                        }
                    }
                }
            }
        })?;
        Ok((Self { seen, shared }, refusals))
    }
}

/// What was believed so many seconds before the latest belief; the oldest that is left, where that is later.
fn believed_at(beliefs: &VecDeque<Belief>, ago: f64) -> Option<Belief> {
    let taken = beliefs.back()?.0 - ago;
    let later = beliefs.partition_point(|(t, _)| *t <= taken);
    beliefs.get(later.saturating_sub(1)).copied()
}

/// Whether somebody still listens; what finds no room is out of date anyway.
fn sent(sender: &SyncSender<Measurement>, measured: Measurement) -> bool {
    !matches!(sender.try_send(measured), Err(std::sync::mpsc::TrySendError::Disconnected(_)))
}

fn look(
    onboard: &mut OnBoard,
    frame: Result<vision::picture::Picture, String>,
    predicted: Option<Belief>,
) -> Result<Option<Measurement>, String> {
    let Some((t, predicted)) = predicted else { return Ok(None) };
    let odometry::Estimate { pose, covariance } = predicted;
    let glance =
        onboard.glance(&frame?, &Estimate { pose, covariance, agreeing: 1.0 }).map_err(|why| why.to_string())?;
    let plain = |found: Estimate| odometry::Estimate { pose: found.pose, covariance: found.covariance };
    match glance {
        Glance { instead: Some(found), .. } => Ok(Some(Measurement::instead(plain(found), t))),
        Glance { pose: Ok(found), .. } => Ok(Some(Measurement::posterior(plain(found), predicted, t))),
        Glance { pose: Err(why), .. } => Err(why.kind().to_owned()),
    }
}

impl PoseSource for Watcher {
    fn arrived(&mut self, _: f64) -> Option<Measurement> {
        self.seen.try_recv().ok()
    }

    fn believed(&mut self, t: f64, belief: &odometry::Estimate) {
        if let Ok(mut beliefs) = self.shared.beliefs.try_lock() {
            if beliefs.len() == KEPT {
                beliefs.pop_front();
            }
            beliefs.push_back((t, *belief));
        }
    }

    fn contradicts(&self) -> bool {
        self.shared.refuted.load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use runs::frames::Pose;

    #[test]
    fn a_picture_is_matched_to_what_was_believed_when_it_was_taken() {
        let at = |t: f64| (t, odometry::Estimate::new(Pose::new(t, 0.0, 0.0), [0.1; 3]));
        let beliefs: VecDeque<Belief> = (0..100).map(|k| at(f64::from(k) * 1e-3)).collect();
        let believed = |ago: f64| believed_at(&beliefs, ago).unwrap().0;
        assert_eq!((believed(0.0), believed(0.0305), believed(0.5)), (0.099, 0.068, 0.0));
        assert!(believed_at(&VecDeque::new(), 0.0).is_none());
    }
}
