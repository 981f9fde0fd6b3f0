"""Who does the measuring: processes here, or a Dask cluster; any executor of concurrent.futures will do.

At most one task a core is under way, so that timed runs do not disturb each other.
"""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import signal
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from typing import Any, Protocol

CONNECTING = 5  # s to wait for a cluster


class WorkersError(Exception):
    """There are no workers to be had; the message is one line for the user."""


class Workers(Protocol):
    """An executor, and how many tasks it may be given at a time."""

    slots: int
    here: bool  # whether what one worker compiles the others find on disk

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]: ...

    def restart(self) -> None:
        """After one has died: with new ones."""

    def close(self) -> None:
        """At once, whatever is under way."""


def silence(library: str) -> None:
    """Nothing of what a library logs, in any of its parts: what the user must know is told in our words."""
    for name in (library, *(name for name in logging.root.manager.loggerDict if name.startswith(f"{library}."))):
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)


async def _ask_scheduler(address: str) -> None:
    """OSError or ValueError unless one answers.

    Before a client is made: one that found nothing waits at its end, and complains; one that something else keeps
    waiting never ends.
    """
    from distributed.core import connect

    async def ask() -> object:
        line = await connect(address, timeout=CONNECTING)
        try:
            await line.write({"op": "identity", "reply": True})
            return await line.read()
        finally:
            line.abort()

    about = await asyncio.wait_for(ask(), CONNECTING)
    if not isinstance(about, dict) or about.get("type") != "Scheduler":
        raise ValueError("what answers is something else")


def cores() -> int:
    """How many this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Processes:
    """A process a core, started afresh: a copy of one that runs threads would be no safe place."""

    here = True

    def __init__(self, slots: int | None = None) -> None:
        self.slots = slots or cores()
        self._executor = self._start()

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        # Ctrl-C goes to all processes of a terminal; these leave it to the one that started them, even while they start
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            return self._executor.submit(function, *arguments)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def restart(self) -> None:
        self.close()
        self._executor = self._start()

    def close(self) -> None:
        processes = list((self._executor._processes or {}).values())
        self._executor.shutdown(wait=False, cancel_futures=True)
        for process in processes:
            process.terminate()
        for process in processes:
            process.join()

    def _start(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(self.slots, multiprocessing.get_context("spawn"))


class Threads:
    """In this process, one thing at a time: for tests, and for what is small."""

    here = True
    slots = 1

    def __init__(self) -> None:
        self._executor = ThreadPoolExecutor(1)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        return self._executor.submit(function, *arguments)

    def restart(self) -> None:
        pass

    def close(self) -> None:
        self._executor.shutdown(wait=False, cancel_futures=True)


class Cluster:
    """The workers of a Dask scheduler: one task a worker process, whatever threads that has. Each has tumble installed.

    address: such as tcp://10.0.0.1:8786. WorkersError if nothing is there.
    """

    here = False

    def __init__(self, address: str) -> None:
        try:
            import distributed
        except ImportError:
            raise WorkersError("distributed is not installed: pip install 'tumble[dask]'") from None
        silence("distributed")
        try:
            asyncio.run(_ask_scheduler(address))
            self._client = distributed.Client(address, timeout=CONNECTING, set_as_default=False)
        except (OSError, ValueError, TypeError, ImportError) as error:
            says = str(error).partition("\n")[0][:200] or f"it kept silent for {CONNECTING} s"
            raise WorkersError(f"no Dask scheduler answers there: {says}") from None
        self.slots = len(self._client.scheduler_info(n_workers=-1)["workers"])
        if not self.slots:
            self._client.close()
            raise WorkersError("its scheduler has no workers")
        self._executor: Executor = self._client.get_executor(pure=False)

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        return self._executor.submit(function, *arguments)

    def restart(self) -> None:
        """The scheduler looks after its workers itself."""

    def close(self) -> None:
        self._executor.shutdown(wait=False)
        self._client.close()
