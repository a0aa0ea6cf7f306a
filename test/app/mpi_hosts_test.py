"""A job over three hosts, which are network namespaces with their own names and addresses. Its picture has the bits of
one process, and after the loss of a host it resumes from the last checkpoint."""

import os
import subprocess
import time

from mpi import ball_scene, skip_without_mpi
from program import PROGRAM, ProgramTest, remove, skip_unless, write

NAME = f"mtx{os.getpid()}"
ADDRESSES = [f"10.91.7.{k}" for k in (1, 2, 3)]
UNHEARD = "error: rank 2 has not answered for"


def ip(*words):
    return subprocess.run(["ip", *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def on_host(k, *words):
    return ip("netns", "exec", f"{NAME}-{k}", *words)


def make_hosts():
    """Creates the namespaces; returns the message of the first command that fails."""
    commands = [f"link add {NAME} type bridge", f"link set {NAME} up"]
    for k in 1, 2, 3:
        host = f"{NAME}-{k}"
        commands += [f"netns add {host}", f"link add {NAME}{k} type veth peer name eth0 netns {host}",
                     f"link set {NAME}{k} master {NAME} up", f"-n {host} addr add {ADDRESSES[k - 1]}/24 dev eth0",
                     f"-n {host} link set eth0 up", f"-n {host} link set lo up"]  # fmt: skip
    for command in [*commands, f"netns exec {NAME}-1 unshare --uts true"]:
        done = ip(*command.split())
        if done.returncode != 0:
            return done.stdout
    return ""


def kill_host(k):
    for process in ip("netns", "pids", f"{NAME}-{k}").stdout.split():
        if process.isdigit():
            subprocess.run(["kill", "-KILL", process], stderr=subprocess.DEVNULL)


def remove_hosts():
    for k in 1, 2, 3:
        kill_host(k)
        ip("netns", "del", f"{NAME}-{k}")
    ip("link", "del", NAME)


class Hosts(ProgramTest):
    @classmethod
    def setUpClass(cls):
        skip_without_mpi()
        version = subprocess.run(["mpirun", "--version"], stdout=subprocess.PIPE, text=True).stdout
        skip_unless("Open MPI" in version, "mpirun is not that of Open MPI")
        cls.addClassCleanup(remove_hosts)
        try:
            message = make_hosts()
        except FileNotFoundError:
            message = "there is no ip"
        skip_unless(not message, f"network namespaces cannot be made here (it takes root): {message}")
        super().setUpClass()

    @classmethod
    def prepare(cls):
        ball_scene()
        # mpirun starts its daemons by `agent HOST COMMAND...` in place of ssh.
        write("agent", f"""#!/bin/sh
k=${{1##*.}}
shift
exec ip netns exec {NAME}-$k unshare --uts sh -c "hostname {NAME}-$k; $*"
""")
        os.chmod("agent", 0o755)
        outcome = cls.hosts(ADDRESSES, ["hostname"]).ended()
        skip_unless(outcome.code == 0, f"mpirun cannot use network namespaces here: {outcome}")
        assert len(set(outcome.text.split())) == 3, f"the job does not have three hosts: {outcome}"

    @classmethod
    def hosts(cls, addresses, command):
        """Starts a job with one process on each of these hosts."""
        return cls.started([
            "ip", "netns", "exec", f"{NAME}-1", "unshare", "--uts", "sh", "-c", f'hostname {NAME}-1; exec "$@"', "-",
            "timeout", "-k", "1", "60", "mpirun", "--mca", "plm_rsh_agent", os.path.abspath("agent"),
            "--mca", "oob_tcp_if_include", "10.91.7.0/24", "--mca", "btl", "tcp,self",
            "--mca", "btl_tcp_if_include", "10.91.7.0/24", "--host", ",".join(addresses), "--bind-to", "none",
            "-n", str(len(addresses)), *command])  # fmt: skip

    def attempt(self, command, unplugged):
        """The outcome of a render whose third host vanishes after the first checkpoint; None where it ended before."""
        remove("state", "state.previous", "many.exr")
        on_host(3, "ip", "link", "set", "eth0", "up")
        job = self.hosts(ADDRESSES, [*command, "--rank-timeout", "2"])
        self.until(lambda: os.path.exists("state"), "a checkpoint", job=job)
        begin = time.monotonic()
        if unplugged:
            on_host(3, "ip", "link", "set", "eth0", "down")
            # mpirun may wait long for the lost host; the picture is written before the message.
            while UNHEARD not in job.output() and job.runs() and time.monotonic() - begin < 30:
                time.sleep(0.1)
            for k in 1, 2, 3:
                kill_host(k)
        else:
            kill_host(3)
        outcome = job.ended()
        self.assertLess(time.monotonic() - begin, 40, outcome)
        if unplugged and UNHEARD in outcome.text:
            return outcome
        if os.path.exists("many.exr") and '"interrupted" = 1' not in self.outcome("info many.exr").text:
            return None
        return outcome

    def check(self, options, unplugged):
        self.quietly(f"render ball.pbrt {options} -o one.exr")
        line = "render ball.pbrt --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05 --resume"
        command = [PROGRAM, *line.split(), *options.split()]
        waited = 0  # MPI may block a render without a message; allowed once
        for _ in range(5):
            outcome = self.attempt(command, unplugged)
            if outcome and unplugged and UNHEARD not in outcome.text and not os.path.exists("many.exr"):
                waited += 1
                self.assertLess(waited, 2, f"no message: {outcome}")
            elif outcome:
                break
        else:
            self.fail("the render had ended before")
        self.assertTrue(os.path.exists("state"), outcome)
        if unplugged:
            self.assertIn(UNHEARD, outcome.text)
        kill_host(3)
        outcome = self.hosts(ADDRESSES[:2], command).ended()
        self.assertEqual(outcome.code, 0, outcome)
        self.assert_same_but_seconds("one.exr", "many.exr")

    def test_host_whose_processes_end(self):
        self.check("--spp 2000 --adaptive on", False)

    def test_host_that_is_cut_off(self):
        """The host itself continues to work."""
        self.check("--spp 256 --integrator bidirectional", True)
