"""`carom plot` and `carom animate`: the picture or film of an archive or a system."""

import argparse
import os
import sys

import carom

ENDINGS = (".png", ".svg", ".pdf")


def read(source):
    """An archive, a system file or a built-in system."""
    is_system = source.endswith(".toml") or ("." not in source and "/" not in source)
    if is_system:
        return carom.load(source) if source.endswith(".toml") else carom.system(source)
    return carom.open(source)


def draw(source, what=None):
    """The figure of what is read; `what`: which of those that there are."""
    thing = read(source)
    there = carom.plot.pictures(thing)
    if not there:
        raise carom.InputError(
            f"{source}: a certified run has no picture", (source, 0, 0, ""), "the same run in doubles"
        )
    if what is not None and what not in there:
        raise carom.plot.no_picture(source, what, there)
    return carom.plot.result(thing, what=what).figure


def animate(source, output, numbers):
    """Saves the film of what is read; `numbers`: texts of frames, fps and trail."""
    given = {}
    for name, text in numbers.items():
        if not (text.isascii() and text.isdigit() and 0 < int(text) <= 1_000_000):
            raise carom.InputError(
                f"--{name}: '{text}' is no such number", ("command line", 0, 0, f"--{name}"), "a whole number from 1 on"
            )
        given[name] = int(text)
    thing = read(source)
    if not isinstance(thing, (carom.System, carom.Run)):
        raise carom.InputError(
            f"{source} has no moving particles", (source, 0, 0, ""), "a system, or the archive of carom run"
        )
    progress = _counter(given.get("frames", 100)) if sys.stderr.isatty() else None
    carom.animate(thing, output, progress=progress, **given)


def _counter(frames):
    """Shows on a terminal how many frames are made."""

    def show(frame):
        sys.stderr.write(f"\rframe {frame} of {frames}" if frame < frames else "\r\033[K")
        sys.stderr.flush()

    return show


def main():
    try:
        make()
    except carom.InputError as error:
        expected = f" (expected {error.expected})" if error.expected not in str(error) else ""
        sys.exit(f"carom: {error}{expected}")
    except IndexError as error:  # of Pillow, which ends a film without a frame so
        if isinstance(error.__context__, SystemExit):
            raise error.__context__ from None
        raise


def make():
    parser = argparse.ArgumentParser(prog="carom plot", description=__doc__)
    parser.add_argument("source", help="an archive, a system file or the name of a built-in system")
    parser.add_argument("-o", "--output", required=True, help="PICTURE.png, .svg or .pdf")
    parser.add_argument("--into", help="the file that is written, instead of PICTURE")
    parser.add_argument("--what", help="which picture, where there are several")
    parser.add_argument("--force", action="store_true", help="replaces a picture that is there")
    parser.add_argument("--dpi", type=float, default=200, help="dots per inch of a .png")
    for name in ("frames", "fps", "trail"):
        parser.add_argument(f"--{name}", help="a number of a film")
    given = parser.parse_args()
    film = given.output.endswith(carom.animation.ENDINGS)
    if not film and not given.output.endswith(ENDINGS):
        raise carom.InputError(
            f"-o {given.output}: neither a picture nor a film", ("command line", 0, 0, "-o"),
            "a name ending in .png, .svg, .pdf, .gif or .mp4",
        )  # fmt: skip
    into = given.into or given.output
    if os.path.exists(into) and not given.force:
        raise carom.InputError(f"{into}: the file exists already", (into, 0, 0, ""))
    if film:
        carom.animation.check(given.output)
    import matplotlib

    matplotlib.use("Agg")
    if film:
        numbers = {"frames": given.frames, "fps": given.fps, "trail": given.trail}
        animate(given.source, into, {name: text for name, text in numbers.items() if text is not None})
    else:
        draw(given.source, given.what).savefig(into, dpi=given.dpi)


if __name__ == "__main__":
    main()
