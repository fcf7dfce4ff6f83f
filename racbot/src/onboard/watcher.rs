//! A thread that looks at pictures, so that the control loop never waits for one.

use super::Refusals;
use super::frames::Frames;
use driver::drive::PoseSource;
use runs::frames::Pose;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::{Glance, OnBoard};

/// Poses that may wait for the control loop: it takes one a tick, which is faster than any camera.
const WAITING: usize = 4;
/// Standard deviations of the controller's belief as a prediction (m, m, rad): what wheels lose between two pictures.
const BELIEF_SD: [f64; 3] = [0.05, 0.05, 0.05];

/// The control loop's end.
pub(super) struct Watcher {
    poses: Receiver<Pose>,
    belief: Arc<Mutex<Option<Pose>>>,
}

impl Watcher {
    /// Starts looking; it ends with the pictures, or when this is dropped.
    pub(super) fn start(mut frames: Box<dyn Frames>, lens: Camera, field: Field) -> std::io::Result<(Self, Refusals)> {
        let (sender, poses) = sync_channel(WAITING);
        let belief = Arc::new(Mutex::new(None));
        let refusals: Refusals = Arc::new(Mutex::new(BTreeMap::new()));
        let (heard, refused) = (Arc::clone(&belief), Arc::clone(&refusals));
        std::thread::Builder::new().name("on-board camera".to_owned()).spawn(move || {
            let mut onboard = OnBoard::new(lens, field);
            while let Some(frame) = frames.next() {
                let predicted = heard.lock().ok().and_then(|pose| *pose);
                match pose(&mut onboard, frame, predicted) {
                    Ok(Some(pose)) if !sent(&sender, pose) => return,
                    Ok(_) => {}
                    Err(why) => {
                        if let Ok(mut refused) = refused.lock() {
                            *refused.entry(why).or_default() += 1;
                        }
                    }
                }
            }
        })?;
        Ok((Self { poses, belief }, refusals))
    }
}

/// Whether somebody still listens; a pose that finds no room is out of date anyway.
fn sent(sender: &SyncSender<Pose>, pose: Pose) -> bool {
    !matches!(sender.try_send(pose), Err(std::sync::mpsc::TrySendError::Disconnected(_)))
}

fn pose(
    onboard: &mut OnBoard,
    frame: Result<vision::picture::Picture, String>,
    predicted: Option<Pose>,
) -> Result<Option<Pose>, String> {
    let Some(predicted) = predicted else { return Ok(None) };
    let glance = onboard.glance(&frame?, &Estimate::new(predicted, BELIEF_SD)).map_err(|why| why.to_string())?;
    match glance {
        Glance { pose: Ok(found), .. } => Ok(Some(found.pose)),
        Glance { pose: Err(why), .. } => Err(why.kind().to_owned()),
    }
}

impl PoseSource for Watcher {
    fn arrived(&mut self, _: f64) -> Option<Pose> {
        self.poses.try_recv().ok()
    }

    fn believed(&mut self, _: f64, pose: Pose) {
        if let Ok(mut belief) = self.belief.try_lock() {
            *belief = Some(pose);
        }
    }
}
