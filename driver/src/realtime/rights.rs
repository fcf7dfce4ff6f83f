//! What the kernel grants a control loop: to run before everybody else, and never to wait for a page.

use rustix::mm::{MlockAllFlags, mlockall};
use thread_priority::unix::{
    RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy, thread_native_id,
};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

/// One right: granted, or why not and what that means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Right {
    /// Short, as in a log.
    pub name: &'static str,
    /// Nothing where it was granted.
    pub refused: Option<String>,
}

/// What was asked for and what was granted; a loop runs without them too, only later.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rights {
    /// `SCHED_FIFO` at this priority for the calling thread.
    pub scheduling: Right,
    /// All memory of the process locked, now and later.
    pub memory: Right,
    /// Priority asked for.
    pub priority: u8,
}

impl Rights {
    /// Asks for both, for the calling thread and its process. Threads that are to stay ordinary are
    /// started before.
    #[must_use]
    pub fn acquire(priority: u8) -> Self {
        let fifo = ThreadPriorityValue::try_from(priority)
            .map_err(|_| "the priority is not 1 to 99".to_owned())
            .and_then(|value| {
                let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
                set_thread_priority_and_policy(thread_native_id(), ThreadPriority::Crossplatform(value), policy)
                    .map_err(|error| error.to_string())
            });
        let scheduling = fifo.err().map(|why| {
            format!(
                "no SCHED_FIFO at priority {priority} ({why}): other programs delay the loop; run as root, or grant it \
                 by LimitRTPRIO= or limits.conf's rtprio"
            )
        });
        let locked = mlockall(MlockAllFlags::CURRENT | MlockAllFlags::FUTURE);
        let memory = locked.err().map(|why| {
            format!(
                "no locked memory ({why}): a page fault may delay the loop; run as root, or grant it by \
                 LimitMEMLOCK=infinity or limits.conf's memlock"
            )
        });
        Self {
            scheduling: Right { name: "SCHED_FIFO", refused: scheduling },
            memory: Right { name: "locked memory", refused: memory },
            priority,
        }
    }

    /// A sentence for every right that was refused.
    pub fn remarks(&self) -> impl Iterator<Item = &str> {
        [&self.scheduling, &self.memory].into_iter().filter_map(|right| right.refused.as_deref())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_priority_that_does_not_exist_is_refused_with_what_to_do() {
        // In a thread of its own, which is all that a granted right would touch beside locked memory.
        let rights = std::thread::spawn(|| Rights::acquire(200)).join().unwrap();
        let remark = rights.remarks().next().unwrap();
        assert!(remark.contains("priority 200") && remark.contains("LimitRTPRIO"), "{remark}");
    }
}
