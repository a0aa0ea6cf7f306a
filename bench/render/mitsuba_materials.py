"""Materials of pbrt as the nearest BSDFs of Mitsuba."""

from __future__ import annotations

import re
from typing import Any, Dict, Tuple

from mitsuba_textures import UNBOUNDED, Converted, Textures, report_rest, rgb
from pbrt_scene import Plugin, Scene

SMOOTH = 0.001  # GGX lobes of this width and below become mirrors
METALS = {"Ag": "Ag", "Al": "Al", "Au": "Au", "Cu": "Cu", "CuZn": "CuZn", "MgO": "MgO", "TiO2": "TiO2"}
GLASSES = {"BK7": 1.5168, "BAF10": 1.67, "FK51A": 1.4866, "LASF9": 1.8503, "F5": 1.6034, "F10": 1.6228, "F11": 1.6206}
# Parameters of pbrt's random walk within coats. Mitsuba's plastics are closed forms without them.
WALK = ("maxdepth", "nsamples", "thickness")


class Materials:
    def __init__(self, scene: Scene) -> None:
        self.scene, self.textures = scene, Textures(scene)

    def bsdf(self, material: Plugin, nesting: int = 0) -> Dict[str, Any]:
        kinds = {
            "": self.interface,
            "interface": self.interface,
            "diffuse": self.diffuse,
            "coateddiffuse": self.coated_diffuse,
            "conductor": self.conductor,
            "coatedconductor": self.coated_conductor,
            "dielectric": self.dielectric,
            "thindielectric": self.thin_dielectric,
            "diffusetransmission": self.diffuse_transmission,
        }
        label = f"material {material.name} ({material.type})" if material.name else f"material {material.type}"
        if material.type == "mix" and nesting < 16:
            converted = self.mix(material, nesting)
        elif material.type in kinds:
            converted = kinds[material.type](material)
        else:
            self.scene.notice(material.place, f"{label} is not converted: grey diffuse is used")
            return two_sided({"type": "diffuse", "reflectance": rgb([0.5] * 3)})
        material.parameters.without_effect("type")
        report_rest(self.scene, material, label)
        return converted

    def interface(self, _: Plugin) -> Dict[str, Any]:
        return {"type": "null"}

    def diffuse(self, m: Plugin) -> Dict[str, Any]:
        return two_sided({"type": "diffuse", "reflectance": self.reflectance(m)})

    def coated_diffuse(self, m: Plugin) -> Dict[str, Any]:
        m.parameters.without_effect(*WALK)
        rough, lobe = self.roughness(m)
        base = {
            "type": "roughplastic" if rough else "plastic",
            "diffuse_reflectance": self.reflectance(m),
            "nonlinear": True,
        }
        if rough and "alpha" not in lobe:  # Mitsuba's plastic is isotropic
            self.scene.notice(m.place, "the coat's two roughnesses become their mean")
            lobe = {"distribution": "ggx", "alpha": 0.5 * (lobe["alpha_u"] + lobe["alpha_v"])}
        return two_sided({**base, **self.eta(m), **lobe})

    def conductor(self, m: Plugin, prefix: str = "") -> Dict[str, Any]:
        rough, lobe = self.roughness(m, prefix)
        metal = {"type": "roughconductor" if rough else "conductor", **lobe}
        reflectance = m.parameters.find("reflectance")
        if reflectance is not None:
            if reflectance.type != "rgb":
                self.scene.notice(
                    m.place, "a conductor's reflectance that is no RGB colour is not converted: 0.9 is used"
                )
            values = [
                min(max(float(v), 0.0), 0.9999)
                for v in (reflectance.values if reflectance.type == "rgb" else [0.9] * 3)
            ]
            k = [2 * r**0.5 / (1 - r) ** 0.5 for r in values]
            return two_sided({**metal, "eta": rgb([1, 1, 1]), "k": {"type": UNBOUNDED, "value": k}})
        eta, k = m.parameters.find(prefix + "eta"), m.parameters.find(prefix + "k")
        named = [re.fullmatch(r"metal-(\w+)-(?:eta|k)", str(p.values[0])) if p else None for p in (eta, k)]
        if (eta is None and k is None) or (named[0] and named[1] and named[0][1] == named[1][1]):
            name = named[0][1] if named[0] else "Cu"
            if name not in METALS:
                self.scene.notice(m.place, f"metal {name} is not converted: Cu is used")
            return two_sided({**metal, "material": METALS.get(name, "Cu")})
        optical = {n: self.textures.color(m.parameters, prefix + n, d, m.place, unbounded=True)
                   for n, d in (("eta", [0.2, 0.92, 1.1]), ("k", [3.9, 2.45, 2.14]))}  # fmt: skip
        return two_sided({**metal, **optical})

    def coated_conductor(self, m: Plugin) -> Dict[str, Any]:
        coat = ["interface." + n for n in ("eta", "roughness", "uroughness", "vroughness")]
        m.parameters.without_effect(*WALK, *coat, "albedo", "g")
        self.scene.notice(m.place, "material coatedconductor becomes its conductor: the coat is left out")
        return self.conductor(m, "conductor.")

    def dielectric(self, m: Plugin) -> Dict[str, Any]:
        rough, lobe = self.roughness(m)
        return {"type": "roughdielectric" if rough else "dielectric", **self.eta(m), **lobe}

    def thin_dielectric(self, m: Plugin) -> Dict[str, Any]:
        return {"type": "thindielectric", **self.eta(m)}

    def diffuse_transmission(self, m: Plugin) -> Dict[str, Any]:
        m.parameters.without_effect("transmittance")
        self.scene.notice(m.place, "material diffusetransmission becomes diffuse: what it transmits is left out")
        return two_sided({"type": "diffuse", "reflectance": self.reflectance(m, 0.25)})

    def mix(self, m: Plugin, nesting: int) -> Dict[str, Any]:
        amount = self.textures.number(m.parameters, "amount", 0.5, m.place)
        given = m.parameters.find("materials")
        names = [str(v) for v in given.values] if given else []
        unknown = [n for n in names if n not in self.scene.materials]
        if len(names) != 2 or unknown:
            self.scene.notice(
                m.place, f"mix of {' and '.join(names) or 'nothing'} is not converted: grey diffuse is used"
            )
            return two_sided({"type": "diffuse", "reflectance": rgb([0.5] * 3)})
        parts = [self.bsdf(self.scene.materials[n], nesting + 1) for n in names]
        return {"type": "blendbsdf", "weight": amount, "first": parts[0], "second": parts[1]}

    def reflectance(self, m: Plugin, default: float = 0.5) -> Converted:
        scale = m.parameters.number("scale", 1)
        if scale != 1:
            self.scene.notice(m.place, f"the material's scale {scale:g} is left out")
        return self.textures.color(m.parameters, "reflectance", [default] * 3, m.place)

    def eta(self, m: Plugin) -> Dict[str, float]:
        """The index of refraction: one number, as Mitsuba's dielectrics have no dispersion."""
        found = m.parameters.find("eta")
        value = m.parameters.number("eta", 1.5)
        if found is not None and found.type == "spectrum":
            if isinstance(found.values[0], str):
                value = GLASSES.get(str(found.values[0]).replace("glass-", ""), 1.5)
            else:
                value = float(found.values[1])
            self.scene.notice(m.place, f"glass with dispersion becomes one of the index {value:g}")
        return {"int_ior": value, "ext_ior": 1.0}

    def roughness(self, m: Plugin, prefix: str = "") -> Tuple[bool, Dict[str, Any]]:
        """Whether the surface is rough, and Mitsuba's parameters for that: pbrt's alpha is the root of its roughness
        unless remaproughness is false."""
        p = m.parameters
        both = self.textures.number(p, prefix + "roughness", 0, m.place)
        given = [self.textures.number(p, prefix + n, both, m.place) if prefix + n in p.given else both
                 for n in ("uroughness", "vroughness")]  # fmt: skip
        p.without_effect(prefix + "uroughness", prefix + "vroughness")
        root = p.flag("remaproughness", True)
        if any(not isinstance(a, float) for a in given):
            self.scene.notice(m.place, "roughness from a texture is not converted: 0.1 is used")
            given = [0.1 if not isinstance(a, float) else a for a in given]
        u, v = (a**0.5 if root else a for a in given)
        if max(u, v) <= SMOOTH:
            return False, {}
        return True, {"distribution": "ggx", **({"alpha": u} if u == v else {"alpha_u": u, "alpha_v": v})}


def two_sided(bsdf: Dict[str, Any]) -> Dict[str, Any]:
    """pbrt's opaque surfaces scatter on both sides, Mitsuba's on one."""
    return {"type": "twosided", "bsdf": bsdf}
