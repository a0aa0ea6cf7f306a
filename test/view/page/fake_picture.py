"""A synthetic render for the tests of the viewer's page: a known picture with noise that falls as 1 / sqrt(samples)."""

from __future__ import annotations

from typing import Any, Dict, List, Optional

import numpy as np

LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# The first components of the mean, where they are asked for.
SPECIALS = np.array([np.nan, np.inf, -1, 0, 6e-8, 65504, -np.inf, 1, 0.0031308], np.float16)


class FakePicture:
    """Layers of a picture with two lights. All coordinates count from the top left."""

    def __init__(self, width: int = 96, height: int = 54, seed: int = 1, reference: bool = True,
                 specials: bool = False) -> None:
        self.width, self.height, self.has_reference, self.specials = width, height, reference, specials
        self.spp, self.samples = 64.0, 0.0
        self.random = np.random.default_rng(seed)
        self.has_light_groups = False
        self.turn(0.0)

    def turn(self, azimuth: float) -> None:
        """Another camera: the picture moves."""
        x, y = np.meshgrid(np.arange(self.width), np.arange(self.height))
        u, v = (x + 0.5) / self.width, (y + 0.5) / self.height
        # From 1e-4 to 50, so that all parts of the tone curves are visible.
        ramp = 10 ** (-4 + 5.7 * ((u + azimuth / 360) % 1))
        hue = 2 * np.pi * v
        key = ramp[..., None] * (0.6 + 0.4 * np.stack([np.cos(hue), np.cos(hue - 2), np.cos(hue + 2)], -1))
        sky = (0.3 * (1 - v))[..., None] * np.array([0.4, 0.6, 1.0]) * np.ones_like(key)
        self.truth = {"light key": key, "light sky": sky}
        # A sphere before a background without depth.
        r2 = ((x - self.width / 2) ** 2 + (y - self.height / 2) ** 2) / (0.4 * self.height) ** 2
        self.depth = np.where(r2 < 1, 3 - np.sqrt(np.maximum(1 - r2, 0)), np.inf)
        nx, ny = (x - self.width / 2) / (0.4 * self.height), -(y - self.height / 2) / (0.4 * self.height)
        normal = np.stack([nx, ny, np.sqrt(np.maximum(1 - r2, 0))], -1)
        self.normal = np.where((r2 < 1)[..., None], normal, 0)
        self.ids = ((x // 20) + 7 * (y // 20)).astype(np.uint32)
        self.restart()

    def restart(self) -> None:
        self.samples = 0.0
        self.noise = {name: self.random.normal(size=light.shape) for name, light in self.truth.items()}

    def names(self) -> List[Dict[str, Any]]:
        def layer(name: str, kind: str, channels: int = 1, form: str = "half") -> Dict[str, Any]:
            return {"name": name, "kind": kind, "channels": channels, "format": form}

        layers = [layer("mean", "color", 3), layer("error", "error"), layer("relative error", "ratio"),
                  layer("samples", "count", form="float")]
        if self.has_reference:
            layers += [layer("reference", "color", 3, "float"), layer("z", "z")]
        layers += [layer("depth", "scalar", form="float"), layer("normal", "vector", 3),
                   layer("material", "id", form="float")]
        if self.has_light_groups:
            layers += [layer(f"light {name}", "color", 3) for name in self.lights()]
        return layers

    def lights(self) -> List[str]:
        return ["key", "sky"]

    def advance(self, samples: float) -> None:
        self.samples = min(self.samples + samples, self.spp)
        for name, noise in self.noise.items():
            # A walk: later pictures resemble earlier ones.
            self.noise[name] = (0.9 * noise + np.sqrt(1 - 0.81) * self.random.normal(size=noise.shape))

    def spread(self) -> float:
        """Standard deviation of the mean over the mean."""
        return 0.5 / np.sqrt(max(self.samples, 1e-9))

    def layer(self, name: str) -> np.ndarray:
        """Rows, columns, channels; in the type of the messages."""
        if name.startswith("light "):
            light = self.truth[name]
            return (light * np.maximum(1 + self.spread() * self.noise[name], 0)).astype(np.float16)
        if name == "mean":
            if self.samples == 0:
                return np.zeros((self.height, self.width, 3), np.float16)
            mean = sum(self.layer(light).astype(np.float32) for light in self.truth).astype(np.float16)
            if self.specials:
                mean.reshape(-1)[:len(SPECIALS)] = SPECIALS
            return mean
        total = sum(self.truth.values())
        error = self.spread() * np.sqrt(sum((light @ LUMINANCE) ** 2 for light in self.truth.values()))
        if self.samples < 2:
            error = np.full_like(error, np.inf)
        if name == "error":
            return error[..., None].astype(np.float16)
        if name == "relative error":
            return (error / (total @ LUMINANCE))[..., None].astype(np.float16)
        if name == "reference":
            return total.astype(np.float32)
        if name == "z":
            z = (self.layer("mean").astype(np.float64) - total) @ LUMINANCE / error
            return z[..., None].astype(np.float16)
        if name == "samples":
            return np.full((self.height, self.width, 1), self.samples, np.float32)
        if name == "depth":
            return self.depth[..., None].astype(np.float32)
        if name == "normal":
            return self.normal.astype(np.float16)
        return self.ids[..., None].view(np.float32)

    def error(self) -> Optional[float]:
        return self.spread() * 0.2 if self.samples >= 2 else None

    def histogram(self) -> Dict[str, Any]:
        ratio = self.layer("relative error").astype(np.float64).ravel()
        known = np.isfinite(ratio)
        logs = np.clip(np.log10(np.maximum(ratio[known], 1e-30)), -4, 0.999)
        counts, _ = np.histogram(logs, bins=50, range=(-4, 1))
        return {"least": -4, "most": 1, "counts": counts.tolist(), "infinite": int((~known).sum())}


REPLAY = """\
sample {sample} of 64 of pixel {x},{y}, sampler sobol, seed 0, strategy mis with the power heuristic
  film                100.7429, 181.1811; filter weight 0.9943617
  camera ray          from (0, 1, 6.8) along (-0.03647361, -0.07116345, -0.9967976)
  wavelengths, nm            389.9326       490.2125        555.561       630.5635

vertex 1: shape 6, triangle 3 of mesh 6, material 6
  position            (-0.2, 0.6, 1.1), distance 5.7
  BSDF                diffuse
    reflectance             0.6562195      0.6961141      0.7121502      0.7222453
  sampled light 0, area light of shape 7, primitive 0, chosen with probability 0.5
    densities         light 14.01749, BSDF 0.008954993 per steradian; weight 0.9999996
    contribution         4.449756e-06   3.444605e-05   5.678709e-05   5.693382e-05

vertex 2: beyond the scene
  direction           (0.1, 0.2, 0.9)
  throughput                  0.51           0.52           0.53           0.54

end: the path left the scene
  radiance               4.449756e-06   3.444605e-05   5.678709e-05   5.693382e-05

                                    R              G              B
  the pixel gets          0.008360129      0.0052104   0.0004075136
"""


def replay_lines(x: int, y: int, sample: int) -> List[Dict[str, Any]]:
    lines = []
    for line in REPLAY.format(x=x, y=y, sample=sample).splitlines():
        level = min((len(line) - len(line.lstrip())) // 2, 2) if line.strip() else 0
        lines.append({"level": level, "text": line.strip()})
    return lines
