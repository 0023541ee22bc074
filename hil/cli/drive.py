"""``hil drive``: orders from the shell through any serial port, and what the robot answers."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Final

import serial
import typer

from hil.cli import show
from hil.client.decode import FrameDecoder, OdometryFrame
from hil.client.orders import KEYWORDS, parse_words
from hil.client.plot import check_plot_file, plot_drive, sonar_points
from hil.serial_url import PortError, gone, open_url

#: Between two orders of one command line: the line's own time for the longest order, and the robot's to act on it.
BETWEEN_ORDERS_S: Final = 0.15
#: Between two looks at whether it is time to end.
READ_TIMEOUT_S: Final = 0.05
#: A port that takes no byte for so long is not being read.
WRITE_TIMEOUT_S: Final = 5.0


def complete_words(incomplete: str) -> list[str]:
    """Shell completion of orders."""
    return [word for word in (*KEYWORDS, "set", "watch") if word.startswith(incomplete)]


def drive(
    port: Annotated[str, typer.Argument(metavar="PORT", help="The device or URL: COM3, socket://..., rfc2217://...")],
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="ORDER...",
            help="Orders, sent in sequence: stop mission tele set V W calibrate init watch.",
            autocompletion=complete_words,
        ),
    ],
    for_s: Annotated[
        float | None,
        typer.Option("--for", metavar="SECONDS", min=0, help="Show frames for this time after the last order."),
    ] = None,
    png: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Draw the trajectory and the point cloud at the end.")
    ] = None,
    json_output: Annotated[
        bool, typer.Option("--json", help="Print one JSON object with all frames at the end.")
    ] = False,
) -> None:
    """Send orders through a serial port; show and draw the frames that the robot sends.

    [bold]Examples[/bold]
      hil drive COM3 mission watch
      hil drive COM3 tele set 0.2 0.0
      hil drive socket://127.0.0.1:4000 watch --for 20 --png drive.png
    """
    with show.user_errors():
        watch = bool(words) and words[-1].lower() == "watch"
        orders = parse_words(words[:-1] if watch else words)
        if png is not None:
            check_plot_file(png)
        unlimited = watch and for_s is None
        listener = _Listener(quiet=json_output, keep=json_output or png is not None)
        sent: list[bytes] = []
        lost: PortError | None = None
        try:
            with (
                open_url(port, read_timeout_s=READ_TIMEOUT_S, write_timeout_s=WRITE_TIMEOUT_S) as line,
                show.ended_by_signals(listener.stop),
            ):
                for data in orders:
                    if listener.stopped:
                        break
                    line.write(data)
                    sent.append(data)
                    listener.listen(line, BETWEEN_ORDERS_S)
                listener.listen(line, None if unlimited else for_s or 0.0)
        except serial.SerialTimeoutException:
            raise ValueError(f"{port} accepts no bytes; is the robot running?") from None
        except BrokenPipeError:
            raise  # who reads our output has gone, not the port
        except OSError as error:  # what came until then is still shown
            lost = gone(port, error)
        if png is not None:
            _plot(png, listener.frames, port)
        if json_output:
            show.print_json(
                {
                    "port": port,
                    "sent": [data.decode("utf-8", "replace") for data in sent],
                    "frames": [list(frame.values) for frame in listener.frames],
                    "malformed": listener.decoder.malformed,
                    "skipped_bytes": listener.decoder.skipped,
                }
            )
        elif watch or for_s or png is not None:
            bad = listener.decoder.malformed
            show.print_line(f"{listener.decoder.frames} frames, {bad} malformed" + (f", drawn to {png}" if png else ""))
        if lost is not None:
            raise lost


class _Listener:
    """Prints frames as they come, and keeps them if they are wanted at the end."""

    def __init__(self, *, quiet: bool, keep: bool) -> None:
        self.decoder = FrameDecoder()
        self.frames: list[OdometryFrame] = []
        self.stopped = False
        self._quiet = quiet
        self._keep = keep

    def stop(self) -> None:
        """End `listen` soon."""
        self.stopped = True

    def listen(self, line: serial.Serial, duration_s: float | None) -> None:
        """Read frames for a time, or until stopped."""
        end = None if duration_s is None else time.monotonic() + duration_s
        while not self.stopped and (end is None or time.monotonic() < end):
            for frame in self.decoder.feed(line.read(max(1, line.in_waiting))):
                if self._keep:
                    self.frames.append(frame)
                if not self._quiet:
                    show.print_line(format_frame(frame))


def format_frame(frame: OdometryFrame) -> str:
    """A frame for people: metres and centimetres."""
    return (
        f"x {frame.x_mm / 1e3:7.3f} m  y {frame.y_mm / 1e3:7.3f} m  theta {frame.theta_rad:3d} rad"
        f"  front {frame.front_mm / 10:6.1f}  right {frame.right_mm / 10:6.1f}  left {frame.left_mm / 10:6.1f} cm"
    )


def _plot(path: Path, frames: list[OdometryFrame], title: str) -> None:
    cloud = []
    for frame in frames:
        cloud += sonar_points(frame)
    odometry = [(frame.x_mm / 1e3, frame.y_mm / 1e3) for frame in frames]
    plot_drive(path, odometry=odometry, cloud=cloud, title=f"{title}: {len(frames)} frames")
