"""The server loop: one thread owns the simulation, takes commands from a queue, keeps real time, publishes frames."""

from __future__ import annotations

import logging
import queue
import threading
import time
from pathlib import Path
from typing import Any

from engine import StepError
from sandbox import commands as ask
from sandbox.clock import Clock
from sandbox.frame import Frame, Status
from sandbox.recorder import OpenRecorder, Recorder
from sandbox.rewind import History
from sandbox.scenes import Scene, find_scene
from sandbox.simulation import TIME_STEP, Simulation
from sandbox.viewer import Viewer

log = logging.getLogger("tumble.session")

MOST_QUEUED = 10_000  # commands: beyond that new ones are dropped
MOST_A_ROUND = 500  # commands obeyed in one round: a flood slows itself down, not the simulation
LONGEST_ROUND = 0.005  # after that no further command is taken up in a round [s]
MOST_A_STEP = 10_000  # physics commands between two steps: a flood must not fill the memory while all stands still
QUIET = 1.0  # between two refusals in the log [s]
IDLE = 0.05  # longest wait for a command [s]


class Session:
    """A running scene that any number of viewers may watch, and any thread may send commands to.

    scene: name. settings: overrides of the world's settings. open_recorder: makes the viewer that writes a recording,
    None if there is no recording here. record_dir: where recordings go. threads: that a step may use.
    """

    def __init__(
        self,
        scene: str,
        *,
        dt: float = TIME_STEP,
        open_recorder: OpenRecorder | None = None,
        record_dir: Path | None = None,
        threads: int = 1,
        **settings: Any,
    ) -> None:
        self._simulation = Simulation(scene, dt, threads=threads, **settings)
        self._history = History(self._simulation)
        self._queue: queue.Queue[Any] = queue.Queue(MOST_QUEUED)
        self._viewers: list[Viewer] = []
        self._viewers_lock = threading.Lock()
        self._recorder = Recorder(open_recorder, record_dir or Path("runs"))
        self._clock = Clock(dt)
        self._paused = False
        self._failure = ""
        self._notice = ""
        self._last_refusal = -QUIET
        self._applied: list[dict[str, Any]] = []  # physics commands since the last step
        self._closing = threading.Event()
        self._thread: threading.Thread | None = None
        self._frame = self._make_frame()

    # --- from any thread ----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Starts the loop's thread."""
        self._clock.restart()
        self._thread = threading.Thread(target=self._run, name="tumble-loop", daemon=True)
        self._thread.start()

    def submit(self, command: ask.Command) -> bool:
        """Puts a command into the queue and returns at once; False if the queue is full, and the command dropped."""
        try:
            self._queue.put_nowait(command)
        except queue.Full:
            return False
        return True

    def add_viewer(self, viewer: Viewer) -> None:
        """From now on it is shown every frame, on the loop's thread; the latest one at once."""
        with self._viewers_lock:
            self._viewers.append(viewer)
            viewer.show(self._frame)

    def remove_viewer(self, viewer: Viewer) -> None:
        with self._viewers_lock:
            if viewer in self._viewers:
                self._viewers.remove(viewer)

    @property
    def frame(self) -> Frame:
        """The latest frame."""
        return self._frame

    @property
    def scene(self) -> Scene:
        """The scene that runs."""
        return find_scene(self._frame.scene)

    @property
    def can_record(self) -> bool:
        return self._recorder.available

    @property
    def last_recording(self) -> Path | None:
        """The last finished recording."""
        return self._recorder.last

    def close(self) -> None:
        """Ends the loop, finishes the recording, closes the viewers."""
        self._closing.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(timeout=10.0)
        self._stop_recording()
        with self._viewers_lock:
            viewers, self._viewers = self._viewers, []
        for viewer in viewers:
            try:
                viewer.close()
            except Exception as error:
                log.error("a viewer failed to close: %s", error)
                log.debug("in the viewer", exc_info=True)

    # --- the loop -----------------------------------------------------------------------------------------------

    def _run(self) -> None:
        """Turn by turn until closed. Nothing that goes wrong in one turn ends the session."""
        while not self._closing.is_set():
            try:
                self._turn()
            except Exception as error:
                log.debug("in the loop", exc_info=True)
                self._take_back(f"{type(error).__name__}: {error}")

    def _turn(self) -> None:
        """One round of the loop: commands, then the steps that are due, then a frame, then sleep."""
        changed = self._drain()
        steps = 0 if self._paused else self._clock.due()
        for _ in range(steps):
            self._step()
            if self._paused:
                break
        if changed and not steps:
            self._publish(self._make_frame())
        self._wait()

    def _wait(self) -> None:
        """Sleeps until the next step is due or, standing still, until a command comes."""
        if self._paused:
            try:
                self._obey(self._queue.get(timeout=IDLE))
                self._publish(self._make_frame())
            except queue.Empty:
                pass
        else:
            self._closing.wait(min(IDLE, self._clock.wait()))

    def _drain(self) -> bool:
        """Obeys the commands that wait; whether there were any."""
        end = time.perf_counter() + LONGEST_ROUND
        for count in range(MOST_A_ROUND):
            if time.perf_counter() > end:
                break
            try:
                command = self._queue.get_nowait()
            except queue.Empty:
                return count > 0
            self._obey(command)
        return True

    def _step(self) -> None:
        """One step, published and recorded; a step that fails is taken back."""
        try:
            self._simulation.step()
        except StepError as error:
            self._take_back(str(error))
            return
        self._history.stepped()
        self._clock.count()
        frame = self._make_frame(tuple(self._applied))
        self._applied.clear()
        try:
            self._recorder.show(frame)
        except Exception as error:  # noqa: BLE001 - of the disk, or of whatever writes the file
            self._tell(f"the recording ended: {error}")
        self._publish(frame)

    def _publish(self, frame: Frame) -> None:
        self._frame = frame
        with self._viewers_lock:
            viewers = list(self._viewers)
        for viewer in viewers:
            try:
                viewer.show(frame)
            except Exception as error:
                log.error("a viewer failed and is dropped: %s", error)
                log.debug("in the viewer", exc_info=True)
                self.remove_viewer(viewer)

    def _make_frame(self, commands: tuple[dict, ...] = ()) -> Frame:
        running = not self._paused
        status = Status(
            paused=self._paused,
            speed=self._clock.speed,
            steps_per_second=self._clock.rate() if running else 0.0,
            behind=running and self._clock.behind(),
            failure=self._failure,
            notice=self._notice,
            recording=self._recorder.name,
        )
        return self._simulation.frame(commands, status)

    def _take_back(self, failure: str) -> None:
        """Brings back the last good state, stands still and says why. A recording ends with that state."""
        self._stop_recording()
        self._history.go_back()
        self._applied.clear()
        self._failure = f"{failure}; gone back to the state before it"
        self._paused = True
        log.error(self._failure)
        self._publish(self._make_frame())

    # --- commands -----------------------------------------------------------------------------------------------

    def _obey(self, command: Any) -> None:
        """Does what a command asks; one that cannot be done is logged, and nothing changes."""
        try:
            if isinstance(command, ask.PhysicsCommand):
                if len(self._applied) >= MOST_A_STEP:
                    raise ValueError(f"commands: must be at most {MOST_A_STEP} between two steps")
                self._simulation.apply(command)
                self._history.applied(command)
                self._applied.append(command.to_dict())
            else:
                self._obey_session(command)
        except ValueError as error:
            self._refuse(str(error))

    def _obey_session(self, command: Any) -> None:
        match command:
            case ask.Pause():
                self._paused = True
            case ask.Play():
                self._go_on()
            case ask.StepOnce():
                self._paused = True
                self._failure = ""
                self._step()
            case ask.SetSpeed(speed):
                self._clock.speed = speed
                self._clock.restart()
            case ask.Reset():
                self._begin(self._simulation.scene)
            case ask.LoadScene(name):
                self._begin(find_scene(name))
            case ask.StartRecording():
                self._start_recording()
            case ask.StopRecording():
                self._stop_recording()
            case _:
                raise ValueError(f"command = {command!r}: must be one of sandbox.commands")

    def _go_on(self) -> None:
        if self._paused:
            self._clock.restart()
        self._paused = False
        self._failure = ""

    def _begin(self, scene: Scene) -> None:
        """A scene begins. The same one again keeps the settings; another one brings its own, but for the solver's."""
        self._failure = self._notice = ""
        self._stop_recording()
        old = self._simulation
        settings = old.world.settings.to_dict()
        if scene.name != old.scene.name:
            settings["gravity"] = scene.defaults().gravity
        self._simulation = Simulation(scene, old.dt, threads=old.world.threads, **settings)
        self._simulation.content = old.content + 1
        self._history = History(self._simulation)
        self._applied.clear()
        self._clock.restart()

    def _start_recording(self) -> None:
        self._stop_recording()
        self._applied.clear()  # what was done before the recording's start is in its snapshot
        self._recorder.start(self._simulation)

    def _stop_recording(self) -> None:
        try:
            finished = self._recorder.stop()
        except Exception as error:  # noqa: BLE001 - of the disk, or of whatever writes the file
            self._tell(f"the recording ended: {error}")
        else:
            if finished is not None:
                self._notice = f"recorded {finished.name}"

    def _refuse(self, reason: str) -> None:
        """Tells of a command that was ignored; in the log at most once a second, for a client may send thousands."""
        self._notice = reason
        now = time.perf_counter()
        if now - self._last_refusal > QUIET:
            self._last_refusal = now
            log.warning("ignored: %s", reason)

    def _tell(self, notice: str) -> None:
        self._notice = notice
        log.warning(notice)
