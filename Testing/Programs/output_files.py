# SPDX-License-Identifier: BSD-3-Clause
"""What morph-mesh writes: a whole file, or none and the old one stays. Tested after a kill at any
moment, on a full disk, and where a file must not be changed. Links, mode and owner stay.

Run: MORPH_MESH=<path of morph-mesh> MESHMORPHING_MODELS=<folder of the small models>
     SAMPLE_FILES=<path of MeshMorphingSampleFiles>
         python3 output_files.py
MORPH_TEST_SEED sets another seed of the moments at which the program is killed; MORPH_TEST_KILLS
their number.
"""
import gzip
import os
import random
import resource
import shutil
import signal
import stat
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import exodus_models
import gmsh_models
import solver_models as models
import vtk_pieces

PROGRAM = os.environ["MORPH_MESH"]
MODELS = Path(os.environ["MESHMORPHING_MODELS"])
GRID = str(MODELS / "canister_hex_small.vtu")
KILLS = int(os.environ.get("MORPH_TEST_KILLS", "120"))
SEED = os.environ.get("MORPH_TEST_SEED", "1")
# From the third on: each is morphed from an original of its own.
OUTPUTS = ["out.vtu", "out.vtk", "out.inp", "out.bdf", "out.su2", "out.msh", "points", "points.gz",
           "out.pvtu", "out.vtm"]
PIECES = (".pvtu", ".vtm")
SOLVERS = {".inp": (models.abaqus, "Wall"), ".bdf": (models.nastran, "PID 2"),
           ".su2": (models.su2, "wall"), ".msh": (gmsh_models.gmsh, "wall"),
           ".exo": (None, "wall"), ".cgns": (None, "wall")}
BOUNDARIES = ("out.vtp", "out.vtk")


class OutputFiles(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.common = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.common.cleanup)
        cls.boundary = Path(cls.common.name) / "boundary.vtp"
        subprocess.run([PROGRAM, "extract", GRID, cls.boundary], check=True,
                       stdout=subprocess.DEVNULL)

        model, rng = models.random_model(SEED, sizes=(6, 8, 10))
        for extension, (write, _) in SOLVERS.items():
            if write:
                cls.original(extension).write_bytes(models.text_of(write(model, rng)))
        cls.outputs = list(OUTPUTS)
        cls.make_library_files(model)
        mesh = models.OpenFoam(model, rng).write(cls.original("case"))
        packed = shutil.copytree(cls.original("case"), cls.original(".gz"))
        points = packed / mesh.relative_to(cls.original("case")) / "points"
        points.with_name("points.gz").write_bytes(gzip.compress(points.read_bytes()))
        points.unlink()
        for extension in PIECES:
            cls.original(extension).parent.mkdir(exist_ok=True)
            vtk_pieces.write(model, cls.original(extension))

    @classmethod
    def make_library_files(cls, model):
        """Those that are made by libraries, where these are installed and morph-mesh has them."""
        if shutil.which("ncgen"):
            cdl = Path(cls.common.name) / "model.cdl"
            cdl.write_text(exodus_models.exodus(model))
            subprocess.run(["ncgen", "-o", cls.original(".exo"), cdl], check=True)
        samples = Path(cls.common.name) / "samples"
        samples.mkdir()
        subprocess.run([os.environ["SAMPLE_FILES"], samples], check=True)
        if (samples / "cube.cgns").exists():
            (samples / "cube.cgns").rename(cls.original(".cgns"))
        for extension in (".exo", ".cgns"):
            result = subprocess.run([PROGRAM, "--list-surfaces", cls.original(extension)],
                                    capture_output=True, text=True)
            if result.returncode == 0:
                cls.outputs.append("out" + extension)
            else:
                print(f"skipped: {extension}: {result.stderr.strip()}")

    @classmethod
    def original(cls, name):
        if name in PIECES:
            return Path(cls.common.name) / f"pieces{name[1:]}" / ("piece" + name)
        return Path(cls.common.name) / ("original" + name)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def command(self, output):
        _, wall = SOLVERS.get(output.suffix, (None, "wall"))
        wall = "Surface 0" if output.suffix in PIECES else wall
        if self.has_original(output):
            return [PROGRAM, "--quiet", "--move", wall, "--translate", "0.05,0.02,-0.03",
                    str(self.original(output.suffix or "case")), str(output)]
        return [PROGRAM, "--quiet", GRID, str(self.boundary), str(output)]

    @staticmethod
    def has_original(output):
        return (output.suffix in SOLVERS or output.suffix in PIECES
                or output.name in ("points", "points.gz"))

    def files(self, name):
        """What a command writes that gets this output."""
        stem, extension = os.path.splitext(name)
        pieces = [f"{stem}_{i}.vtu" for i in range(2)] if extension in PIECES else []
        return [self.folder / file for file in (*pieces, name)]

    def write_old(self, name, content=b"old"):
        for path in self.files(name):
            path.write_bytes(content)

    def assert_old(self, name):
        for path in self.files(name):
            self.assertEqual(path.read_bytes(), b"old")
        self.only(*(path.name for path in self.files(name)))

    def run_program(self, command, **options):
        return subprocess.run(command, capture_output=True, text=True, timeout=120, **options)

    def whole(self, path):
        """Another run reads it."""
        command = [PROGRAM, "extract", str(path), str(path) + ".check.vtp"]
        return self.run_program(command).returncode == 0

    def fails(self, result, message):
        self.assertEqual(result.returncode, 1, result.stderr)
        errors = [line for line in result.stderr.splitlines() if "warning: " not in line]
        self.assertEqual(len(errors), 1, result.stderr)
        self.assertRegex(errors[0], "^morph-mesh: Cannot write .*" + message)

    def only(self, *names):
        """No temporary file is left."""
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), sorted(names))

    def commands(self):
        for name in self.outputs:
            yield name, self.command(self.folder / name)
        for name in BOUNDARIES:
            yield name, [PROGRAM, "extract", "--quiet", GRID, str(self.folder / name)]

    def test_a_limit_on_the_size_of_files_leaves_the_old_file(self):
        for name, command in self.commands():
            self.run_program(command, check=True)
            size = max(path.stat().st_size for path in self.files(name))
            # The file holds seconds, so that its size varies.
            for limit in (0, 1, size // 2, size * 19 // 20):
                with self.subTest(name=name, limit=limit):
                    self.write_old(name)
                    limits = resource.RLIMIT_FSIZE, (limit, limit)
                    result = self.run_program(
                        command, preexec_fn=lambda limits=limits: resource.setrlimit(*limits))
                    self.fails(result, "File too large")
                    self.assert_old(name)
            for path in self.files(name):
                path.unlink()

    def test_a_full_disk_leaves_the_old_file(self):
        for name, command in self.commands():
            self.run_program(command, check=True)
            files = self.files(name)
            size = sum(path.stat().st_size for path in files)
            for path in files:
                path.unlink()
            for part in (0, 0.5, 0.9):  # of what is needed, free besides the old files
                pages = len(files) + int(part * size / 4096)
                with self.subTest(name=name, pages=pages):
                    disk = self.run_program(["mount", "-t", "tmpfs", "-o", f"size={4 * pages}k",
                                             "none", str(self.folder)])
                    if disk.returncode != 0:
                        self.skipTest("no right to mount a small disk")
                    try:
                        self.write_old(name)
                        result = self.run_program(command)
                        self.fails(result, "No space left on device")
                        self.assert_old(name)
                    finally:
                        subprocess.run(["umount", str(self.folder)], check=True)

    def kill(self, moment, command, output):
        """Ends the program by SIGKILL; says whether it had ended before."""
        program = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        before = output.stat()
        if moment is None:  # as soon as the folder shows that it writes
            names = set(os.listdir(self.folder))
            while (program.poll() is None and set(os.listdir(self.folder)) == names
                   and output.stat() == before):
                pass
            time.sleep(self.random.expovariate(2000))
        else:
            time.sleep(moment)
        program.send_signal(signal.SIGKILL)
        return program.wait() == 0

    def test_a_kill_leaves_the_old_file_or_the_new_one(self):
        print(f"seed {SEED}, {KILLS} kills")
        self.random = random.Random(SEED)
        for name in self.outputs:
            output = self.folder / name
            command = self.command(output)
            start = time.monotonic()
            self.run_program(command, check=True)
            duration = time.monotonic() - start
            new = [path.read_bytes() for path in self.files(name)]
            ended = 0
            for i in range(KILLS // len(self.outputs)):
                self.write_old(name)
                delay = None if i % 2 else self.random.uniform(0, 1.2 * duration)
                ended += self.kill(delay, command, output)
                for path, content in zip(self.files(name), new):
                    with self.subTest(name=path.name, kill=i):
                        found = path.read_bytes()
                        # A grid that no solver reads holds seconds, so that runs differ.
                        self.assertTrue(found in (b"old", content) or
                                        not self.has_original(output) and self.whole(path))
                    for temporary in self.folder.glob(f".{path.name}.*"):
                        temporary.unlink()
            self.assertLess(ended, KILLS // len(self.outputs))
            for path in self.files(name):  # points beside points.gz would be in the way
                path.unlink()

    def test_an_interrupt_removes_the_temporary_file(self):
        output = self.folder / "out.vtk"
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for _ in range(5):
                output.write_bytes(b"old")
                program = subprocess.Popen(self.command(output), stderr=subprocess.DEVNULL)
                while program.poll() is None and len(os.listdir(self.folder)) == 1:
                    pass
                program.send_signal(number)
                self.assertIn(program.wait(), (0, -number))
                self.only("out.vtk")

    def test_mode_and_owner_are_kept_and_new_files_follow_the_mask(self):
        output = self.folder / "out.vtu"
        old_mask = os.umask(0o027)
        self.addCleanup(os.umask, old_mask)
        self.run_program(self.command(output), check=True)
        self.assertEqual(stat.S_IMODE(output.stat().st_mode), 0o640)
        for mode in (0o600, 0o666, 0o755):
            output.write_bytes(b"old")
            output.chmod(mode)
            if os.getuid() == 0:
                os.chown(output, 12345, 23456)
            owner = output.stat().st_uid, output.stat().st_gid
            self.run_program(self.command(output), check=True)
            self.assertGreater(output.stat().st_size, 10000)
            self.assertEqual(stat.S_IMODE(output.stat().st_mode), mode)
            self.assertEqual((output.stat().st_uid, output.stat().st_gid), owner)

    def test_symbolic_links_stay(self):
        real = self.folder / "real"
        real.mkdir()
        for exists in (True, False):  # the second: a link to a file that is not there yet
            target = real / f"target{exists}.vtu"
            if exists:
                target.write_bytes(b"old")
            link, links = self.folder / f"link{exists}.vtu", self.folder / f"links{exists}.vtu"
            link.symlink_to(Path("real") / target.name)
            links.symlink_to(link)
            self.run_program(self.command(links), check=True)
            self.assertTrue(link.is_symlink() and links.is_symlink())
            self.assertTrue(self.whole(target))
        circle = self.folder / "circle.vtu"
        circle.symlink_to(circle.name)
        self.fails(self.run_program(self.command(circle)), "too many symbolic links")

    def test_what_must_not_be_replaced(self):
        (self.folder / "folder.vtu").mkdir()
        self.fails(self.run_program(self.command(self.folder / "folder.vtu")), "no regular file")
        os.symlink("/dev/null", self.folder / "device.vtk")
        self.fails(self.run_program(self.command(self.folder / "device.vtk")), "no regular file")
        self.fails(self.run_program(self.command(self.folder / "none" / "out.vtu")),
                   "No such file or directory")

    def test_what_is_read_only_stays(self):
        output = self.folder / "out.vtu"
        output.write_bytes(b"old")
        output.chmod(0o444)
        options = {}
        if os.getuid() == 0:  # for whom nothing is read-only
            options["user"] = 65534
            os.chmod(self.common.name, 0o755)
            os.chown(self.folder, 65534, 65534)
            os.chown(output, 65534, 65534)
        self.fails(self.run_program(self.command(output), **options), "Permission denied")
        output.chmod(0o644)
        self.folder.chmod(0o555)
        self.addCleanup(self.folder.chmod, 0o755)
        self.fails(self.run_program(self.command(output), **options), "Permission denied")
        self.assertEqual(output.read_bytes(), b"old")

    def test_the_input_may_be_the_output(self):
        grid = self.folder / "grid.vtu"
        grid.write_bytes(Path(GRID).read_bytes())
        self.run_program([PROGRAM, "--quiet", str(grid), str(self.boundary), str(grid)], check=True)
        self.assertTrue(self.whole(grid))

    def test_a_solvers_file_may_be_the_output(self):
        """Each format: it becomes what a copy would be."""
        for name in self.outputs:
            if not self.has_original(Path(name)):
                continue
            with self.subTest(name=name):
                command = self.command(self.folder / name)
                self.run_program(command, check=True)
                expected = [path.read_bytes() for path in self.files(name)]
                for path in self.files(name):
                    path.unlink()
                original = Path(command[-2])
                if original.is_dir():
                    copy = shutil.copytree(original, self.folder / "in")
                    out = copy / "constant" / "polyMesh" / name
                    changed = [out]
                elif name.endswith(PIECES):  # named as the copy's, since the list names them
                    folder = shutil.copytree(original.parent, self.folder / "in")
                    for path in [*folder.iterdir()]:
                        path.write_bytes(path.read_bytes().replace(b"piece_", b"out_"))
                        path.rename(path.with_name(path.name.replace("piece", "out")))
                    copy = out = folder / name
                    changed = [folder / path.name for path in self.files(name)]
                else:
                    (self.folder / "in").mkdir()
                    copy = out = Path(shutil.copy(original, self.folder / "in"))
                    changed = [copy]
                before = [path.read_bytes() for path in changed]
                self.run_program([*command[:-2], str(copy), str(out)], check=True)
                self.assertEqual([path.read_bytes() for path in changed], expected)
                self.assertNotEqual(before, expected)
                shutil.rmtree(self.folder / "in")

    def test_a_long_name(self):
        output = self.folder / ("x" * 250 + ".vtu")
        self.run_program(self.command(output), check=True)
        self.assertTrue(output.exists())


if __name__ == "__main__":
    unittest.main()
