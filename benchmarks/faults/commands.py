"""Commands as processes of their own that start within milliseconds: forked from a server that has imported all.

Kernels are read by the server too, so that a command that is killed had begun to work.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
CONTEXT = multiprocessing.get_context("forkserver")
CONTEXT.set_forkserver_preload(["benchmarks.faults.warm"])
LONGEST = 120.0
"""s that a command may take."""


class Command:
    """``rocking WORDS`` running, or ``work(*WORDS)``; ``largest_file`` (bytes) stands for a disk that is full there."""

    def __init__(
        self, *words: str | Path, largest_file: int | None = None, work: Callable[..., object] | None = None
    ) -> None:
        reader, writer = CONTEXT.Pipe(duplex=False)
        self._output: Connection = reader
        self.process: BaseProcess = CONTEXT.Process(
            target=_run, args=(work or _command_line, list(map(str, words)), writer, largest_file)
        )
        self.process.start()
        writer.close()

    @property
    def running(self) -> bool:
        return self.process.is_alive()

    def signal(self, number: int, group: bool = False) -> None:
        """Send a signal to the command, or to it and all that it started."""
        with suppress(ProcessLookupError):
            (os.killpg if group else os.kill)(self.process.pid or 0, number)

    def end(self, seconds: float = LONGEST) -> tuple[int, str]:
        """Wait for the end: exit code (negative: of a signal; 124: never came) and what was said."""
        self.process.join(seconds)
        code = self.process.exitcode
        if code is None:
            self.signal(signal.SIGKILL, group=True)
            self.process.join()
        said = b""
        os.set_blocking(self._output.fileno(), False)
        try:
            while piece := os.read(self._output.fileno(), 1 << 16):
                said += piece
        except BlockingIOError:  # a worker that is about to end still holds the pipe
            pass
        self._output.close()
        return 124 if code is None else code, said.decode("utf-8", "replace")


def _run(work: Callable[..., object], words: list[str], writer: Connection, largest_file: int | None) -> None:
    os.setsid()
    signal.signal(signal.SIGINT, signal.default_int_handler)
    for stream in (1, 2):
        os.dup2(writer.fileno(), stream)
    if largest_file is not None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (largest_file, largest_file))
    work(*words)


def _command_line(*words: str) -> None:
    from rocking.command import main

    sys.argv = ["rocking", *words]
    main()


def run(
    *words: str | Path, largest_file: int | None = None, work: Callable[..., object] | None = None
) -> tuple[int, str]:
    """Run a command to its end: exit code and what it said."""
    return Command(*words, largest_file=largest_file, work=work).end()


def environment(root: Path = ROOT) -> dict[str, str]:
    """The environment of a process that runs the code under ``root``."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, [str(root), os.environ.get("PYTHONPATH", "")]))}


class Cluster:
    """A dask scheduler and workers, processes of their own that may be killed one by one; logs in ``folder``."""

    def __init__(self, folder: Path, worker_root: Path = ROOT, workers: int = 2) -> None:
        self.folder, self.worker_root, self._started = folder, worker_root, 0
        words = ("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        self.scheduler, line = self._start(words, ROOT, "Scheduler at:")
        self.address = line.split()[-1]
        self.workers = [self._worker() for _ in range(workers)]

    def _start(self, words: Sequence[str], root: Path, ready: str) -> tuple[subprocess.Popen[bytes], str]:
        """A process and the line of its log that says it is ready."""
        self._started += 1
        log = self.folder / f"{words[0]}_{self._started}.log"
        with log.open("wb") as file:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", *words], env=environment(root), cwd=self.folder,
                stdout=file, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
        until = time.monotonic() + LONGEST
        while time.monotonic() < until and process.poll() is None:
            line = next((line for line in log.read_text("utf-8", "replace").splitlines() if ready in line), None)
            if line is not None:
                return process, line
            time.sleep(0.05)
        raise RuntimeError(f"dask {words[0]} does not start: {log.read_text('utf-8', 'replace')[-500:]}")

    def _worker(self) -> subprocess.Popen[bytes]:
        words = ("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard")
        return self._start(words, self.worker_root, "Registered to:")[0]

    def kill_worker(self, number: int) -> None:
        """Kill a worker and start another in its place."""
        self.workers[number].kill()
        self.workers[number].wait()
        self.workers[number] = self._worker()

    def stop(self) -> None:
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.wait()


@contextmanager
def cluster(worker_root: Path = ROOT) -> Iterator[Cluster]:
    """Two workers and their scheduler on this machine, listening on loopback only."""
    with TemporaryDirectory() as folder:
        found = Cluster(Path(folder), worker_root)
        try:
            yield found
        finally:
            found.stop()
