"""Rows, answers and a clock that are written out, for tests of the benchmark."""

from contactlab.study.benchmark import Row


def row(error=1.0, time=1.0, options="steps=10", failed=0, method="a", **entries):
    names = {
        "error_worst": error, "books_worst": 0.0, "sweep_time_s": time,
        "status": "SUCCESS",
    }  # fmt: skip
    return Row(method=method, options=options, error_rms=error, time_s=time, failed=failed,
               **(names | entries))  # fmt: skip
