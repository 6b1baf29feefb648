# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm cluster of one node, this computer's, on the loopback address, with all that it writes in one folder."""
import contextlib
import os
import pathlib
import shutil
import socket
import subprocess
import time

from test_pacs import free_port

SETTINGS = """
ClusterName=trial
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CredType=cred/munge
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
ReturnToService=2
SchedulerParameters=sched_interval=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory={memory}
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def installed():
    """Its daemons are there, and we may run them."""
    return os.geteuid() == 0 and all(shutil.which(p) for p in ("slurmctld", "slurmd", "munged", "mungekey", "sbatch"))


@contextlib.contextmanager
def one_node(folder):
    """Environment under which sbatch finds the cluster, which ends with the context."""
    folder = pathlib.Path(folder)
    for part in ("munge", "state", "spool"):
        (folder / part).mkdir(parents=True)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20 - 512
    # A task of the recipe asks for two cores.
    (folder / "slurm.conf").write_text(SETTINGS.format(folder=folder, host=socket.gethostname().split(".")[0], controller=free_port(), node=free_port(), memory=memory,
                                                       cores=max(2, os.cpu_count())))
    environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
    key = folder / "munge/key"
    subprocess.run(["mungekey", "--create", "--keyfile", key], check=True)
    daemons = [["munged", "--foreground", "--force", "--key-file", key, "--socket", folder / "munge/socket", "--pid-file",
                folder / "munge/pid", "--seed-file", folder / "munge/seed", "--log-file", folder / "munge/log"],
               ["slurmctld", "-D"], ["slurmd", "-D"]]
    running = []
    try:
        for daemon in daemons:
            running.append(subprocess.Popen(daemon, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
            time.sleep(1)
        end = time.monotonic() + 120
        while "idle" not in subprocess.run(["sinfo", "--noheader", "--format=%T"], env=environment, capture_output=True, text=True).stdout:
            if time.monotonic() > end or any(d.poll() is not None for d in running):
                logs = "".join(log.read_text(errors="replace")[-800:] for log in sorted(folder.rglob("*log")))
                raise RuntimeError(f"Slurm did not come up: {logs}")
            time.sleep(0.5)
        yield environment
    finally:
        subprocess.run(["scancel", "--user=root"], env=environment, capture_output=True)
        for daemon in reversed(running):
            daemon.terminate()
        for daemon in running:
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()
