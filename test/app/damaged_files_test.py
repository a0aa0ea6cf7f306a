"""Damaged pictures and models: each gives a picture or one error message, in bounded time and memory."""

import mmap
import resource
import shutil

from program import PROGRAM, SHARED, SKY, ProgramTest, scene, skip_unless

SECONDS, BYTES = 10, 3 << 29


def has_sanitizer():
    """Whether the program is built with sanitizers, which reserve address space."""
    with open(PROGRAM, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as image:
        return image.find(b"__asan_init") >= 0


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))


class DamagedFiles(ProgramTest):
    @classmethod
    def setUpClass(cls):
        skip_unless((SHARED / "bad").is_dir(), f"{SHARED / 'bad'} is absent")
        super().setUpClass()
        cls.limit = None if has_sanitizer() else staticmethod(limit_memory)

    def attempt(self, world):
        scene("attempt", world)
        outcome = self.outcome("render attempt.pbrt --threads 2", seconds=SECONDS, preexec_fn=self.limit)
        if outcome.code != 0:
            self.assertEqual(outcome.code, 1, outcome)
            self.assertEqual(outcome.text.count("\n"), 1, outcome)
            self.assertTrue(outcome.text.startswith("montelux: error: attempt.pbrt:"), outcome)

    def files(self, *patterns, least):
        found = sorted(file for pattern in patterns for file in (SHARED / "bad").glob(pattern) if file.is_file())
        self.assertGreater(len(found), least, "damaged files were found")
        return found

    def test_pictures(self):
        """Each file under its own name and renamed to .exr, as a texture and as an environment."""
        for file in self.files("exr/*", "images/*", least=45):
            shutil.copy(file, "named.exr")
            for name in file, "named.exr":
                with self.subTest(file.name, name=str(name)):
                    self.attempt(f"""{SKY} Texture "t" "spectrum" "imagemap" "string filename" "{name}"
Material "diffuse" "texture reflectance" "t" Shape "sphere\"""")
                with self.subTest(file.name, name=str(name), environment=True):
                    self.attempt(f'LightSource "infinite" "string filename" "{name}" Shape "sphere"')

    def test_models(self):
        for file in self.files("models/*", "models/*/*", least=10):
            with self.subTest(file.name):
                self.attempt(f'{SKY} Shape "plymesh" "string filename" "{file}"')
