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


def animate(source, output):
    """Saves the film of what is read."""
    thing = read(source)
    if not isinstance(thing, (carom.System, carom.Run)):
        raise carom.InputError(
            f"{source} has no moving particles", (source, 0, 0, ""), "a system, or the archive of carom run"
        )
    carom.animate(thing, output, progress=_counter() if sys.stderr.isatty() else None)


def _counter(frames=100):
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
        animate(given.source, into)
    else:
        draw(given.source, given.what).savefig(into, dpi=given.dpi)


if __name__ == "__main__":
    main()
