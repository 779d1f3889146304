"""A Slurm of one node, without systemd: a munge with a key of its own, the controller and the node's daemon."""
import contextlib
import os
import re
import signal
import subprocess

from event_log import EventLog

CONFIGURATION = """
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={place}/munge/socket,cred_expire=5
CredType=cred/munge
SlurmctldPort=16817
SlurmdPort=16818
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
SlurmdParameters=config_overrides
JobRequeue=1
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
KillWait=20
SchedulerParameters=batch_sched_delay=0,sched_min_interval=0,sched_interval=2
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/none
MpiDefault=none
NodeName=localhost NodeAddr=127.0.0.1 CPUs=4 RealMemory=16000 State=UNKNOWN
PartitionName=low Nodes=ALL Default=YES PriorityTier=1 PreemptMode=REQUEUE State=UP
PartitionName=high Nodes=ALL PriorityTier=10 PreemptMode=OFF State=UP
"""


class Cluster:
    """Its commands are run by run(); `log` is the controller's.  Partition low, the default, gives way to high.

    place: an empty directory.  environment: of the commands, and so of the jobs."""

    def __init__(self, place, environment):
        self.place = place
        self.environment = dict(environment, SLURM_CONF=str(place / "slurm.conf"))
        for name in ("munge", "state", "spool"):
            (place / name).mkdir(mode=0o755)
        (place / "slurm.conf").write_text(CONFIGURATION.format(place=place))
        key = place / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        # Where there is nothing but loopback, slurmd's getaddrinfo (AI_ADDRCONFIG) finds no address to listen at.
        for words in ("add eth0 type veth peer name eth1", "set eth0 up", "set eth1 up"):
            subprocess.run(["ip", "link", *words.split()], check=True)
        subprocess.run(["ip", "address", "add", "192.0.2.1/32", "dev", "eth0"], check=True)
        self.daemons = []
        _, munge = self.daemon("munged", "--foreground", "--force", f"--key-file={key}",
                               f"--socket={place}/munge/socket", f"--pid-file={place}/munge/pid",
                               f"--log-file={place}/munge/log", f"--seed-file={place}/munge/seed")
        munge.wait_for("Created .* work threads")
        _, self.log = self.daemon("slurmctld", "-D", "-c")
        self.log.wait_for("Running as primary controller")
        _, node = self.daemon("slurmd", "-D", "-N", "localhost")
        node.wait_for("slurmd started")

    def daemon(self, *words):
        process = subprocess.Popen(words, env=self.environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        log = EventLog(process.stderr)
        self.daemons.append(process)
        return process, log

    def close(self):
        """Ends the daemons; jobs end with the namespace of the test."""
        for process in reversed(self.daemons):
            with contextlib.suppress(ProcessLookupError):
                process.send_signal(signal.SIGTERM)
            process.wait()

    def run(self, *words):
        return subprocess.run(words, env=self.environment, cwd=self.place, check=True, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, text=True).stdout.strip()

    def submit(self, *words):
        """The id of the job."""
        return self.run("sbatch", "--parsable", *map(str, words))

    def allocated(self, job, since=0, times=1):
        """Waits until so many tasks of the array have a node; the ids of their jobs by their tasks."""
        matches = self.log.wait_for(rf"Allocate JobId={job}_(\d+)\((\d+)\)", since, times)
        return {int(match[1]): int(match[2]) for match in matches}

    def completed(self, job, since=0, times=1):
        """Waits until so many tasks of the array have ended by themselves; their exit codes by their tasks."""
        matches = self.log.wait_for(rf"_job_complete: JobId={job}_(\d+)\(\d+\) WEXITSTATUS (\d+)", since, times)
        return {int(match[1]): int(match[2]) for match in matches}

    def queue(self, name="affskel-workers"):
        """States of the allocations of this name, by task."""
        text = self.run("squeue", "--noheader", "--array", f"--name={name}", "--format=%i %T")
        return dict(line.split() for line in text.splitlines())

    def fact(self, job, name):
        """A field of scontrol show job."""
        return re.search(rf"\b{name}=(\S*)", self.run("scontrol", "show", "job", str(job)))[1]
