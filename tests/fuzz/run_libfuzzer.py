# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the libFuzzer target for some seconds on small real files: run_libfuzzer.py PROGRAM SECONDS FOLDER ...

What is found is left in the working folder as crash-..., timeout-... or oom-..., as libFuzzer does."""
import pathlib
import shutil
import subprocess
import sys
import tempfile

program, seconds, *folders = sys.argv[1:]
with tempfile.TemporaryDirectory() as corpus:
    seeds = []
    for folder in folders:
        if pathlib.Path(folder).is_dir():
            seeds += [p for p in sorted(pathlib.Path(folder).rglob("*")) if p.is_file() and 200 < p.stat().st_size < 40_000]
    for number, seed in enumerate(seeds[:400]):
        shutil.copyfile(seed, pathlib.Path(corpus) / f"seed{number}")
    code = subprocess.run([program, corpus, f"-max_total_time={seconds}", "-timeout=2", "-rss_limit_mb=1024",
                           "-max_len=40000", "-seed=1", "-print_final_stats=1", "-detect_leaks=0"]).returncode
sys.exit(code)
