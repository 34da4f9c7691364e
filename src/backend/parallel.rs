use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::backend::ItemBuffers;
use crate::camera::{View, Window};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::raster::ItemBufferPair;

/// How [`draw_all`] may run.
#[derive(Clone, Copy)]
pub struct Workload<'a> {
    /// The window of all views.
    pub window: Window,
    /// Bytes that all workers together may take; `None` for no limit.
    pub memory_limit: Option<u64>,
    /// What the work is called in progress reports.
    pub phase: &'static str,
    /// Who listens.
    pub progress: &'a dyn Progress,
}

/// Draws every view once, in parallel, and hands each pair of buffers to `consume` with the view's number.
///
/// `consume` runs on many threads and in any order: what it adds up must not depend on the order (integers, or one slot
/// a view). Threads are those of the current rayon pool, fewer where the memory limit asks for it.
///
/// # Errors
/// What the backend says, what `consume` says, [`Error::Limit`] if not even one worker fits the memory limit,
/// [`Error::Cancelled`].
pub fn draw_all<B: ItemBuffers>(
    backend: &B,
    views: &[View],
    load: Workload<'_>,
    consume: impl Fn(usize, &ItemBufferPair) -> Result<()> + Sync,
) -> Result<()> {
    let workers = worker_count(backend.bytes_per_worker(load.window), views.len(), load.memory_limit)?;
    let (next, done, stop) = (AtomicU64::new(0), AtomicU64::new(0), AtomicBool::new(false));
    let first_error = Mutex::new(None);
    let work = || -> Result<()> {
        let mut scratch = B::Scratch::default();
        let mut buffers = ItemBufferPair::new(load.window);
        while !stop.load(Ordering::Relaxed) {
            let number = next.fetch_add(1, Ordering::Relaxed) as usize;
            let Some(view) = views.get(number) else { break };
            load.progress.check()?;
            backend.draw(view, &mut scratch, &mut buffers)?;
            consume(number, &buffers)?;
            load.progress.report(load.phase, done.fetch_add(1, Ordering::Relaxed) + 1, views.len() as u64);
        }
        Ok(())
    };
    rayon::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|_| {
                if let Err(error) = work() {
                    stop.store(true, Ordering::Relaxed);
                    first_error.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                }
            });
        }
    });
    first_error.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

fn worker_count(bytes_per_worker: u64, views: usize, memory_limit: Option<u64>) -> Result<usize> {
    let threads = rayon::current_num_threads().min(views).max(1);
    let Some(limit) = memory_limit else { return Ok(threads) };
    let affordable = (limit / bytes_per_worker.max(1)) as usize;
    if affordable == 0 {
        let mib = |bytes: u64| bytes.div_ceil(1 << 20);
        return Err(Error::Limit {
            message: format!(
                "drawing needs {} MiB a thread, the memory limit leaves {} MiB; raise --memory-limit or lower \
                 --resolution",
                mib(bytes_per_worker),
                mib(limit)
            ),
        });
    }
    Ok(threads.min(affordable))
}
