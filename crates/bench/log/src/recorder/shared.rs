//! State that the senders and the writing thread share.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError, RwLock, RwLockReadGuard};

use crate::{Body, Event, LogError, Message, Stream};

#[derive(Debug, Default)]
pub(super) struct Shared {
    /// Why no message is accepted any more. A sender holds the lock for reading while it hands a
    /// message over, so that no message follows the last one.
    stopped: RwLock<Option<String>>,
    queued: AtomicUsize,
    losses: Mutex<BTreeMap<Stream, Loss>>,
}

#[derive(Clone, Copy, Debug)]
struct Loss {
    messages: u64,
    first_ns: u64,
    last_ns: u64,
}

impl Shared {
    /// Prevents the log from being stopped while the result is held.
    pub(super) fn running(&self) -> Result<RwLockReadGuard<'_, Option<String>>, LogError> {
        let stopped = self.stopped.read().unwrap_or_else(PoisonError::into_inner);
        match &*stopped {
            Some(why) => Err(LogError::Stopped { why: why.clone() }),
            None => Ok(stopped),
        }
    }

    /// Refuses every message from now on. The first reason is kept.
    pub(super) fn stop(&self, why: &str) {
        let mut stopped = self.stopped.write().unwrap_or_else(PoisonError::into_inner);
        stopped.get_or_insert_with(|| why.to_owned());
    }

    /// Takes a place in the queue, if fewer than `room` are taken.
    pub(super) fn reserve(&self, room: usize) -> bool {
        let more = |queued| (queued < room).then_some(queued + 1);
        self.queued
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, more)
            .is_ok()
    }

    /// Releases a place in the queue.
    pub(super) fn release(&self) {
        self.queued.fetch_sub(1, Ordering::Relaxed);
    }

    pub(super) fn queued(&self) -> usize {
        self.queued.load(Ordering::Relaxed)
    }

    /// Remembers a refused message.
    pub(super) fn lose(&self, stream: Stream, bench_ns: u64) {
        let mut losses = self.losses.lock().unwrap_or_else(PoisonError::into_inner);
        let loss = losses.entry(stream).or_insert(Loss {
            messages: 0,
            first_ns: bench_ns,
            last_ns: bench_ns,
        });
        loss.messages += 1;
        loss.first_ns = loss.first_ns.min(bench_ns);
        loss.last_ns = loss.last_ns.max(bench_ns);
    }

    /// The gaps that are not marked yet, and their total number of messages.
    pub(super) fn take_gaps(&self) -> (Vec<Message>, u64) {
        let losses = std::mem::take(&mut *self.losses.lock().unwrap_or_else(PoisonError::into_inner));
        let lost = losses.values().map(|loss| loss.messages).sum();
        let gap = |(stream, loss): (Stream, Loss)| Message {
            bench_ns: loss.last_ns,
            body: Body::Event(Event::Gap {
                stream: Some(stream),
                cause: "the disk did not keep up".to_owned(),
                from_ns: loss.first_ns,
                to_ns: loss.last_ns,
                lost: Some(loss.messages),
            }),
        };
        (losses.into_iter().map(gap).collect(), lost)
    }
}
