"""A render needs as much memory for many samples per pixel as for few."""

import re

from program import ProgramTest, write

FEW, MANY = 16, 16384
SIZE = 2048  # pixels of the sky; at this size the page count fluctuates by less than the tolerance
TOLERANCE = 1.01


class Memory(ProgramTest):
    @classmethod
    def prepare(cls):
        write("sky.pfm", b"PF\n%d %d\n-1\n" % (SIZE, SIZE) + b"?" * (12 * SIZE * SIZE))
        write("scene.pbrt", 'Film "rgb" "integer xresolution" 8 "integer yresolution" 8\nWorldBegin\n'
              'LightSource "infinite" "string filename" "sky.pfm"\nShape "sphere"\n')  # fmt: skip

    def peak(self, spp, options):
        """Peak memory of one render in MiB."""
        text = self.expect(0, "peak memory", f"render scene.pbrt --spp {spp} --threads 1 --stats -o out.exr {options}")
        return float(re.search(r"^peak memory\s+(\S+)", text, re.M)[1])

    def check(self, options):
        """Compares the least peaks of several runs: kernels count pages in batches, so single peaks fluctuate, while
        growth shows in every run."""
        few = many = float("inf")
        for runs in range(1, 5):
            few = min(few, self.peak(FEW, options))
            many = min(many, self.peak(MANY, options))
            if many <= TOLERANCE * few:
                break
        peaks = f"{few} MiB for {FEW} samples per pixel, {many} MiB for {MANY}, the least of {runs}"
        print(peaks, end=" ... ")
        self.assertLessEqual(many, TOLERANCE * few, peaks)
        self.assertGreater(min(few, many), 24 * SIZE * SIZE / 2**20, "less than the picture of the scene alone")

    def test_independent_sampler(self):
        self.check("--sampler independent")

    def test_sobol_sampler(self):
        self.check("--sampler sobol")

    def test_adaptive(self):
        self.check("--adaptive on")
