"""Every installed composition that fits, listed once a process: making each takes a second."""

from functools import cache

from contactlab.study.bench_methods import methods

every_method = cache(methods)
