//! A thread that looks at pictures, so that the control loop never waits for one.

use super::Refusals;
use super::frames::Frames;
use driver::drive::PoseSource;
use model::measurement::Measurement;
use model::odometry;
use std::collections::BTreeMap;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex};
use vision::camera::Camera;
use vision::field::Field;
use vision::localise::Estimate;
use vision::onboard::{Glance, OnBoard};

/// Measurements that may wait for the control loop: it takes one a tick, which is faster than any camera.
const WAITING: usize = 4;

/// What the controller believes, and at which second of the drive.
type Belief = (f64, odometry::Estimate);

/// The control loop's end.
pub(super) struct Watcher {
    seen: Receiver<Measurement>,
    belief: Arc<Mutex<Option<Belief>>>,
}

impl Watcher {
    /// Starts looking; it ends with the pictures, or when this is dropped.
    pub(super) fn start(mut frames: Box<dyn Frames>, lens: Camera, field: Field) -> std::io::Result<(Self, Refusals)> {
        let (sender, seen) = sync_channel(WAITING);
        let belief = Arc::new(Mutex::new(None));
        let refusals: Refusals = Arc::new(Mutex::new(BTreeMap::new()));
        let (heard, refused) = (Arc::clone(&belief), Arc::clone(&refusals));
        std::thread::Builder::new().name("on-board camera".to_owned()).spawn(move || {
            let mut onboard = OnBoard::new(lens, field);
            while let Some(frame) = frames.next() {
                let predicted = heard.lock().ok().and_then(|belief| *belief);
                match look(&mut onboard, frame, predicted) {
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
        Ok((Self { seen, belief }, refusals))
    }
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
    match glance {
        Glance { pose: Ok(found), .. } => {
            let found = odometry::Estimate { pose: found.pose, covariance: found.covariance };
            Ok(Some(Measurement::posterior(found, predicted, t)))
        }
        Glance { pose: Err(why), .. } => Err(why.kind().to_owned()),
    }
}

impl PoseSource for Watcher {
    fn arrived(&mut self, _: f64) -> Option<Measurement> {
        self.seen.try_recv().ok()
    }

    fn believed(&mut self, t: f64, belief: &odometry::Estimate) {
        if let Ok(mut heard) = self.belief.try_lock() {
            *heard = Some((t, *belief));
        }
    }
}
