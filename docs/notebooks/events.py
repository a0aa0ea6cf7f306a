# %% [markdown]
# # Events: from a cross-section to unweighted samples
#
# For physicists who generate events, and for everyone who wants samples of a function that they can only evaluate. An
# integration learns where its integrand is large. Here that knowledge is kept: saved, drawn from, and used again.
# [docs/sampling.md](../sampling.md) is the guide.

# %%
import math

import numpy as np

import montelux
from montelux import TrainedDensity

# %% [markdown]
# ## A resonance
#
# Two partons with momentum fractions $x_{1,2} = \frac{m}{E} e^{\pm y}$ of beams of energy $E/2$ annihilate to a pair of leptons of mass $m$. The
# resonance is a Breit-Wigner curve of mass $M$ and width $\Gamma$; $c$ is the cosine of the angle in the rest frame, $y$ the
# rapidity, and $x\,(1-x)^3$ stands for parton densities. Units are arbitrary.

# %%
E, M, WIDTH = 1000.0, 91.19, 2.495


def luminosity(m, y):
    x1, x2 = m / E * np.exp(y), m / E * np.exp(-y)
    inside = (x1 < 1) & (x2 < 1)
    return np.where(inside, (1 - x1) ** 3 * (1 - x2) ** 3, 0) / m


def resonance(m):
    s = m * m
    return 1e3 * s / ((s - M**2) ** 2 + (M * WIDTH) ** 2)


def cross_section(x):
    m, y, c = x[:, 0], x[:, 1], x[:, 2]
    return luminosity(m, y) * resonance(m) * (1 + c * c + 0.3 * c)


domain = [(60, 120), (-2, 2), (-1, 1)]
r = montelux.integrate(cross_section, domain, "adaptive", evaluations=200_000, seed=1)
print(r)

# %% [markdown]
# The result holds the density that the method trained, close to the integrand over its integral. It is a value like any
# other: it pickles, and it has a file format with a checksum.

# %%
r.density.notes = {"model": "a resonance at 91.19"}
r.density.save("resonance.mx")
density = TrainedDensity.load("resonance.mx")
print(density)
print(density.notes)

# %% [markdown]
# ## Unweighted events
#
# A draw of the density has the weight $w = f/p$. Keeping it with probability $w / w_{max}$ makes all weights equal, and the
# share that is kept is the efficiency. The maximum comes from a pilot. A few later draws may exceed it; they are kept with
# their larger weights, so that the events follow $f$ exactly.

# %%
events = density.unweighted(cross_section, 100_000, seed=2)
print(f"{len(events)} events from {events.draws} draws, efficiency {events.efficiency:.4f} +- {events.efficiency_error:.4f}")
print(f"weights above 1: {events.overweight}, at most {events.largest_weight:.2f}")
print(f"integral {events.integral:.4f} +- {events.standard_error:.4f}")

# %% [markdown]
# This resonance lies along an axis, which suits the maps of Vegas, too. They multiply densities of one variable each, so a
# ridge across the axes defeats them, but not the mixture:

# %%
def ridge(x):
    return np.exp(-0.5 * ((x[:, 0] - x[:, 1]) / 0.02) ** 2)


for name, f, region in ("resonance", cross_section, domain), ("ridge", ridge, [(0, 1), (0, 1)]):
    for method in "adaptive", "vegas":
        trained = montelux.integrate(f, region, method, evaluations=100_000, seed=1).density
        efficiency = trained.unweighted(f, 2000, seed=2).efficiency
        print(f"{name:10} {method:9} {100 * efficiency:5.1f} % of the draws are kept")

# %% [markdown]
# Weighted samples reject nothing. Their weights add up to the integral.

# %%
weighted = density.samples(cross_section, 20_000, seed=5)
print(f"{len(weighted)} samples are worth {weighted.effective_sample_size:.0f} unweighted ones")
print(f"their weights add up to {weighted.weights.sum():.4f} +- {weighted.standard_error:.4f}")
print(f"mean mass {np.average(weighted.points[:, 0], weights=weighted.weights):.3f}")

# %% [markdown]
# The exact curve: $y$ and $c$ integrated by cubature, bin by bin. Pearson's chi-squared compares counts with it.

# %%
edges = np.concatenate([np.linspace(60, 84, 7), np.linspace(86, 97, 12), np.linspace(100, 120, 6)])
angles = 2 * (1 + 1 / 3)


def exact(low, high):
    def plane(x):
        return luminosity(x[:, 0], x[:, 1]) * resonance(x[:, 0])

    return angles * montelux.integrate(plane, [(low, high), (-2, 2)], "cubature", relative_error=1e-6).value


curve = np.array([exact(low, high) for low, high in zip(edges[:-1], edges[1:])])
counts, _ = np.histogram(events.points[:, 0], edges, weights=events.weights)
squares, _ = np.histogram(events.points[:, 0], edges, weights=events.weights**2)
expected = curve / curve.sum() * counts.sum()
chi_squared = float(((counts - expected) ** 2 / squares).sum())
print(f"chi-squared of the counts {chi_squared:.1f} for {len(curve) - 1} degrees of freedom")
assert chi_squared < 60

# %% [markdown]
# ## A histogram without events
#
# All draws, with their weights, say more than the events that rejection keeps. `histogram` gives the integral over each bin
# in absolute numbers, with the covariance of all bins.

# %%
h = density.histogram(cross_section, lambda x: x[:, 0], edges, 100_000, seed=3)
difference = h.value - curve
chi_squared = float(difference @ np.linalg.solve(h.covariance, difference))
print(f"total {h.integral:.4f} +- {h.standard_error:.4f}, exactly {curve.sum():.4f}")
print(f"chi-squared with the full covariance {chi_squared:.1f} for {len(curve)} degrees of freedom")
assert chi_squared < 60

# %%
import matplotlib.pyplot as plt

figure, axes = plt.subplots(figsize=(6.4, 3.4), dpi=80, layout="constrained")
middles, widths = (edges[1:] + edges[:-1]) / 2, np.diff(edges)
axes.stairs(curve / widths, edges, color="#D55E00", label="exact")
errors = np.sqrt(np.diag(h.covariance))
axes.errorbar(middles, h.value / widths, errors / widths, fmt=".", color="#0072B2", label="100000 draws")
axes.set(xlabel="m", ylabel="cross-section per unit of m", yscale="log")
axes.legend()
plt.show()

# %% [markdown]
# ## Means of observables
#
# The forward-backward asymmetry is a mean over the events. Both forms know their errors, and quotients know the covariance of
# their parts. Exactly it is $0.3 / (8/3) = 0.1125$.

# %%
a = density.expectations(cross_section, lambda x: np.sign(x[:, 2]), 200_000, seed=4)
print(f"from all draws {a.mean[0]:.4f} +- {math.sqrt(a.mean_covariance[0, 0]):.4f}")
signs = np.sign(events.points[:, 2])
print(f"from events    {np.average(signs, weights=events.weights):.4f} +- {1 / math.sqrt(len(signs)):.4f}")

# %% [markdown]
# ## Another integrand
#
# A heavier resonance by half a width: the density still fits well enough to start from.

# %%
heavier = montelux.integrate(
    lambda x: luminosity(x[:, 0], x[:, 1]) * resonance(x[:, 0] - WIDTH / 2) * (1 + x[:, 2] ** 2),
    domain,
    montelux.Trained(density),
    relative_error=2e-3,
)
print(heavier)

# %% [markdown]
# ## From a shell
#
# The same in three commands:
#
#     montelux integrate '(1-m/1000*exp(y))^3*(1-m/1000*exp(-y))^3*m/((m^2-91.19^2)^2+(91.19*2.495)^2)*(1+c^2+0.3*c)*1e3' \
#         --over m=60:120 --over y=-2:2 --over c=-1:1 --method adaptive --evaluations 200k --save-density resonance.mx
#     montelux sample --from resonance.mx --unweighted --n 1e5 -o events.npy
#     montelux sample --from resonance.mx --histogram m=60:120:30 --n 1e5 -o histogram.csv
#
# [docs/sampling.md](../sampling.md#from-a-shell) says what they print.
