"""A bar that shows how far a run is."""

from typing import Any, Callable


def progress_bar(**options: Any) -> Callable[[int, int, float], None]:
    """What `progress` of a run can call: a bar of tqdm, in a notebook a widget (with `ipywidgets`).

        deck.run("out", progress=peridyne.progress_bar())

    `options` are those of `tqdm.auto.tqdm`, e.g. `desc="crack"`. Needs tqdm: `pip install tqdm`.
    """
    try:
        from tqdm.auto import tqdm
    except ImportError as error:
        raise ImportError("a progress bar is one of tqdm: pip install tqdm") from error
    bar = None

    def progress(done: int, steps: int, seconds: float) -> None:
        nonlocal bar
        if bar is None:
            # a run that goes on has done some
            bar = tqdm(total=steps, initial=done, unit=" steps", **options)
        bar.update(done - bar.n)
        if done >= steps:
            bar.close()

    return progress
