# %% [markdown]
# # Sampling: random variables, point sets, and several densities at once
#
# For students and teachers of Monte Carlo, and for everyone who needs samples of a density. Every sampler here is a *map*:
# uniform numbers in, points of the density out. Why that matters is the thread of this notebook. `make lab` draws far more
# figures of this kind ([docs/lab.md](../lab.md)).

# %%
import math

import numpy as np

import montelux
from montelux import Distribution

# %%
import matplotlib.pyplot as plt

plt.rcParams.update({"figure.figsize": (6.4, 3.4), "figure.dpi": 80, "figure.constrained_layout.use": True})
plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
blue, orange, green, purple = "#0072B2", "#D55E00", "#009E73", "#CC79A7"  # Okabe and Ito (2008)

# %% [markdown]
# ## Inversion
#
# If $U$ is uniform on $[0, 1)$, then $F^{-1}(U)$ has the distribution function $F$. For the exponential law that is one
# line of algebra, $F(x) = 1 - e^{-\lambda x}$, so $x = -\ln(1 - u)/\lambda$, and the library does the same:

# %%
u = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
waiting = Distribution.exponential(2)
print("by hand ", -np.log(1 - u) / 2)
print("sample  ", waiting.sample(u))
x = waiting.draw(100_000, seed=1)
print(f"mean of 100000 values {x.mean():.4f} +- {x.std() / math.sqrt(len(x)):.4f}, exactly 0.5")

# %% [markdown]
# `sample(u)` maps the uniforms that you bring, `draw(n, seed)` brings its own. There is no rejection anywhere: one uniform
# makes one value, and larger uniforms make larger values. So whatever is good about the uniforms - strata, low
# discrepancy, antithetic pairs - is still good about the values.
#
# ## Families
#
# Every law knows `pdf`, `cdf`, `quantile`, and both tails with all their digits: beyond 9 standard deviations
# `1 - cdf(x)` has none left.

# %%
normal = Distribution.normal()
print("cdf(1.96)          ", f"{normal.cdf(1.96):.6f}")
print("1 - cdf(9)         ", 1 - normal.cdf(9))
print("cdf_complement(9)  ", f"{normal.cdf_complement(9):.12e}")
print("quantile_complement", f"{normal.quantile_complement(1e-300):.6f}")

# %% [markdown]
# Laws are made from laws: truncated, scaled, mixed.

# %%
laws = {
    "normal": normal,
    "normal in [0, 1.5]": normal.truncated(0, 1.5),
    "Student, 3 degrees": Distribution.student_t(3),
    "two normals": Distribution.mixture([1, 2], [Distribution.normal(-2, 0.4), Distribution.normal(1.5, 0.8)]),
}
for name, law in laws.items():
    total = montelux.integrate(law.pdf, (law.lower, law.upper), relative_error=1e-8)
    print(f"{name:20} integrates to {total.value:.8f}, median {law.quantile(0.5):8.5f}")

# %%
figure, axes = plt.subplots()
t = np.linspace(-4.5, 4.5, 600)
for (name, law), colour, dashes in zip(laws.items(), (blue, orange, green, purple), ("-", "--", "-.", ":")):
    axes.plot(t, law.pdf(t), dashes, color=colour, lw=2, label=name)
axes.set(xlabel="x", ylabel="density")
axes.legend(loc="upper left")
plt.show()

# %% [markdown]
# ## A density of your own
#
# Any function that is not negative will do; it need not be normalised. $e^{-x^4}$ is in no book of families:

# %%
quartic = Distribution.from_density(lambda x: math.exp(-(x**4)), -math.inf, math.inf)
values = quartic.draw(20_000, seed=3)
scale = 2 * math.gamma(5 / 4)  # the integral of exp(-x^4)
print(f"pdf(0) {quartic.pdf(0.0):.12f}, exactly {1 / scale:.12f}")
second = values**2
error = second.std() / math.sqrt(len(values))
print(f"E[x^2] {second.mean():.4f} +- {error:.4f}, exactly {math.gamma(0.75) / math.gamma(0.25):.4f}")

# %% [markdown]
# Each value solves $F(x) = u$ with some fifty calls of your function. Where a table will do, `tabulated` is the fast form; it
# is linear between nodes and exact for what it is.

# %%
nodes = np.linspace(-2.2, 2.2, 200)
table = Distribution.tabulated(nodes, np.exp(-(nodes**4)))
print(f"largest distance of the distribution functions {np.max(np.abs(table.cdf(nodes) - quartic.cdf(nodes))):.1e}")

# %%
figure, axes = plt.subplots()
axes.hist(values, bins=60, density=True, color=blue, alpha=0.6, label="20 000 values")
axes.plot(nodes, quartic.pdf(nodes), color=orange, lw=2, label="density")
axes.set(xlabel="x", ylabel="density")
axes.legend()
plt.show()

# %% [markdown]
# ## Points: random, and better than random
#
# Independent points clump and leave holes. The points of Halton, Hammersley and Sobol' are laid out so that every box has
# about its share. The *star discrepancy* is the largest difference between the share of points in a box $[0, a)$ and its
# area; it is computed exactly.

# %%
kinds = {"independent": "shift", "halton": "none", "sobol": "scramble"}
sets = {kind: montelux.points(kind, 256, 2, how, seed=5) for kind, how in kinds.items()}
for kind, points in sets.items():
    print(f"{kind:12} star discrepancy of 256 points {montelux.star_discrepancy(points):.4f}")

# %%
figure, axes = plt.subplots(1, 3, figsize=(7.6, 2.9), sharey=True)
for a, (kind, points) in zip(axes, sets.items()):
    a.plot(*points.T, ".", color=blue, ms=4)
    a.set(title=kind, xlabel="$u_1$", aspect="equal", xlim=(0, 1), ylim=(0, 1))
axes[0].set(ylabel="$u_2$")
plt.show()

# %% [markdown]
# How the discrepancy falls with the number of points, beside $1/\sqrt N$ and $1/N$:

# %%
counts = 2 ** np.arange(3, 11)
discrepancy = {
    kind: [montelux.star_discrepancy(montelux.points(kind, int(n), 2, how, seed=5)) for n in counts]
    for kind, how in kinds.items()
}
slopes = {kind: np.polyfit(np.log(counts), np.log(d), 1)[0] for kind, d in discrepancy.items()}
print({kind: f"{slope:.2f}" for kind, slope in slopes.items()})

# %%
figure, axes = plt.subplots()
for (kind, d), colour, mark in zip(discrepancy.items(), (blue, orange, green), "o^D"):
    axes.loglog(counts, d, color=colour, marker=mark, label=kind)
axes.loglog(counts, 1 / np.sqrt(counts), "k:", label=r"$1/\sqrt{N}$")
axes.loglog(counts, 1 / counts, "k--", label="$1/N$")
axes.set(xlabel="number of points N", ylabel="star discrepancy")
axes.legend()
plt.show()

# %% [markdown]
# ## Maps keep what the points are worth
#
# Now the thread: put both kinds of uniforms through the *same* inversion, and look at the mean of the values over 200
# seeds. The Sobol' points stay better after they have become normal variables.


# %%
def spread_of_the_mean(kind, randomisation, count, seeds=200):
    means = [normal.sample(montelux.points(kind, count, 1, randomisation, seed=s)).mean() for s in range(seeds)]
    return np.std(means)


for count in (16, 64, 256):
    random, sobol = spread_of_the_mean("independent", "shift", count), spread_of_the_mean("sobol", "scramble", count)
    print(
        f"{count:4} values: independent {random:.4f}, Sobol' {sobol:.4f}, {(random / sobol) ** 2:6.0f} times the samples"
    )

# %% [markdown]
# ## Warps: two dimensions, and the sphere
#
# A warp is a map from the unit square to a surface. Where it spreads out, points are sparse: **the density is one over the
# change of area**. A test of that sentence: move $u$ a little, measure the parallelogram that comes out.


# %%
def change_of_area(warp, u, h=1e-6):
    columns = []
    for axis in np.eye(2):
        columns.append((warp.sample(u + h * axis) - warp.sample(u - h * axis)) / (2 * h))
    if warp.coordinates == 2:
        return np.abs(np.linalg.det(np.stack(columns, -1)))
    return np.linalg.norm(np.cross(*columns), axis=-1)


u = 0.05 + 0.9 * montelux.points("halton", 500, 2)
for warp in (
    montelux.warp.uniform_disk_polar,
    montelux.warp.uniform_disk_concentric,
    montelux.warp.uniform_sphere,
    montelux.warp.cosine_hemisphere,
    montelux.warp.uniform_cone(0.9),
):
    product = change_of_area(warp, u) * warp.pdf(warp.sample(u))
    back = warp.inverse(warp.sample(u))
    exact = np.allclose(back, u, rtol=0, atol=1e-14)
    print(f"{warp.name:24} area x density from {product.min():.5f} to {product.max():.5f}; inverse exact: {exact}")

# %%
figure, axes = plt.subplots(1, 2, figsize=(5.6, 3.0))
line = np.linspace(0, 0.9999, 200)
for a, name in zip(axes, ("uniform_disk_polar", "uniform_disk_concentric")):
    warp = getattr(montelux.warp, name)
    for level in np.linspace(0, 0.9999, 9):
        a.plot(*warp.sample(np.stack([np.full(200, level), line], -1)).T, color=blue, lw=1)
        a.plot(*warp.sample(np.stack([line, np.full(200, level)], -1)).T, color=orange, lw=1)
    a.set(title=name, aspect="equal", xlabel="x", ylabel="y")
plt.show()

# %% [markdown]
# Both maps of the square's grid have cells of equal area, so both sample the disk uniformly. Those of the right one stay
# compact, and strata with them.
#
# ## Several densities: multiple importance sampling
#
# A narrow peak upon a broad hill. A density for the peak has enormous weights on the hill, one for the hill seldom meets
# the peak. Veach and Guibas (1995) take samples of *both* and weigh each by which density would rather have made it.

# %%
peak, hill = Distribution.normal(0.3, 0.005), Distribution.normal(0.5, 0.25)


def f(x):
    return np.exp(-((x - 0.3) ** 2) / (2 * 0.005**2)) + 0.05 * np.exp(-((x - 0.5) ** 2) / (2 * 0.25**2))


exact = math.sqrt(2 * math.pi) * (0.005 + 0.05 * 0.25)
line_ = (-math.inf, math.inf)
methods = {
    "the peak's density": montelux.Importance(peak),
    "the hill's density": montelux.Importance(hill),
    "both, balance heuristic": montelux.MultipleImportance([peak, hill]),
    "both, power heuristic": montelux.MultipleImportance([peak, hill], weights="power"),
}
for name, method in methods.items():
    r = montelux.integrate(f, line_, method, evaluations=20_000, seed=1)
    print(f"{name:24} {r.value:.5f} +- {r.standard_error:.5f}, warnings: {len(r.warnings)}")
print(f"{'exactly':24} {exact:.5f}")

# %% [markdown]
# The peak's density alone has an error that looks small and is wrong: most of the hill lies where it never samples, and the
# warnings say so. `mis_weights` gives the weights themselves; at each point they sum to one.

# %%
x = np.linspace(0.2, 0.4, 400)
densities = np.stack([peak.pdf(x), hill.pdf(x)], axis=-1)
balance, power = montelux.mis_weights(densities, "balance"), montelux.mis_weights(densities, "power")
print(f"sums of the weights: {balance.sum(-1).min():.6f} to {balance.sum(-1).max():.6f}")

# %%
figure, axes = plt.subplots()
for i, (name, colour) in enumerate((("peak", blue), ("hill", orange))):
    axes.plot(x, balance[:, i], color=colour, lw=2, label=f"{name}, balance")
    axes.plot(x, power[:, i], "--", color=colour, lw=2, label=f"{name}, power")
axes.set(xlabel="x", ylabel="weight of a sample at x")
axes.legend(loc="center right")
plt.show()

# %% [markdown]
# ## When only ratios are known: Metropolis chains
#
# A density that is known up to a constant, in more dimensions than one can invert: a random walk that is accepted or stays
# where it is. Its states follow the density, but they are correlated: the error has to know that, and does.


# %%
def log_density(x):  # a bent ridge (after Haario, Saksman and Tamminen 1999)
    return -(x[0] ** 2) / 2 - (x[1] - x[0] ** 2 / 2) ** 2


chains = montelux.metropolis(log_density, [[-3, 4], [0, 0], [3, 4], [0, 3]], samples=5000, seed=2)
for name, mean, error, rhat, size, truth in zip(
    "xy", chains.mean, chains.standard_error, chains.r_hat, chains.effective_sample_size, (0, 0.5)
):
    print(
        f"E[{name}] {mean:6.3f} +- {error:.3f}, exactly {truth}; R-hat {rhat:.4f}, worth {size:.0f} independent states"
    )
print(f"{chains.states.shape} states, {100 * chains.acceptance_rate:.0f} % accepted; warnings: {list(chains.warnings)}")

# %% [markdown]
# The 20 000 states are worth far fewer independent ones: that is what the walk costs. R-hat compares the four
# chains, which began far apart; near 1 they have forgotten
# where. Above 1.01 there would be a warning.

# %%
figure, axes = plt.subplots(1, 2, figsize=(7.4, 3.2), width_ratios=(1, 1.4))
axes[0].plot(*chains.states[:, ::10].reshape(-1, 2).T, ".", color=blue, ms=2)
axes[0].set(xlabel="x", ylabel="y", title="every tenth state")
for states, colour in zip(chains.states, (blue, orange)):
    axes[1].plot(states[:300, 0], color=colour, lw=1)
axes[1].set(xlabel="step", ylabel="x", title="two of the chains, 300 steps")
plt.show()

# %% [markdown]
# ## Where next
#
# - [integration.ipynb](integration.ipynb): these samples at work; [rendering.ipynb](rendering.ipynb): light paths as samples
# - [docs/distributions.md](../distributions.md): every family, inversion, truncation; [docs/random.md](../random.md): which
#   point set when
