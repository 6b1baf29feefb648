# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs glisson-cli. Standard library only."""
import json
import os
import shutil
import subprocess
import threading

# What Slicer sets for its own programs, and what would make another program load Slicer's libraries.
NOT_OURS = ("LD_LIBRARY_PATH", "LD_PRELOAD", "PYTHONHOME", "PYTHONPATH", "QT_PLUGIN_PATH", "QT_QPA_PLATFORM_PLUGIN_PATH")

MEANINGS = {1: "failed", 2: "wrong usage", 3: "bad input", 4: "not converged", 5: "cancelled", 6: "partly failed"}


class GlissonError(RuntimeError):
    """The program refused or failed: its own sentence, and its exit code (MEANINGS)."""

    def __init__(self, message, code):
        super().__init__(message)
        self.code = code


def program(environment=None):
    """Path of glisson-cli: GLISSON_CLI, else from PATH. Raises GlissonError where there is none."""
    environment = os.environ if environment is None else environment
    given = environment.get("GLISSON_CLI")
    found = shutil.which(given or "glisson-cli", path=environment.get("PATH"))
    if not found:
        raise GlissonError("glisson-cli was not found; install the package glisson, or name the program in GLISSON_CLI", 2)
    return found


def clean_environment(environment=None):
    """The environment without what Slicer set for itself."""
    environment = os.environ if environment is None else environment
    return {name: value for name, value in environment.items() if name not in NOT_OURS}


def run(verb, *arguments, progress=None, environment=None):
    """Runs a verb with --json and returns its object.

    progress: called with (percent 0 to 100, words) as the program reports, and may return False to end it.
    Raises GlissonError with the program's last line where it does not end with 0 and prints no object; a result that is marked
    as not converged (code 4) is an error too.
    """
    command = [program(environment), verb, *map(str, arguments), "--json"]
    last = ""
    printed = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=clean_environment(environment)) as process:
        # Both pipes are read at once, so that neither fills up.
        reader = threading.Thread(target=lambda: printed.append(process.stdout.read()))
        reader.start()
        for line in map(str.strip, process.stderr):
            percent, separator, words = line.partition(" %  ")
            if separator and percent.isdigit():
                if progress and progress(int(percent), words) is False:
                    process.terminate()
            elif line:
                last = line
        reader.join()
        code = process.wait()
    if code != 0:
        raise GlissonError(last or f"glisson-cli {verb} ended with {code} ({MEANINGS.get(code, 'unknown')})", code)
    return json.loads(printed[0])
