# %% [markdown]
# # Integration: from a first integral to an error you can defend
#
# For everyone who has an integral and needs its value *with an error*: physicists, quants, statisticians.
# All numbers below come from the library; run the cells in order, and you get the same digits.
#
# `pip install .` in the repository builds the package ([docs/python.md](../python.md)). NumPy is all that it needs; the
# figures here are drawn by matplotlib.

# %%
import math
from pathlib import Path

import numpy as np

import montelux

# %%
import matplotlib.pyplot as plt

plt.rcParams.update({"figure.figsize": (6.4, 3.6), "figure.dpi": 80, "figure.constrained_layout.use": True})
plt.rcParams.update({"axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False})
blue, orange, green, purple = "#0072B2", "#D55E00", "#009E73", "#CC79A7"  # Okabe and Ito (2008)

# %% [markdown]
# ## One line
#
# A function, a range, and the error that you can live with:

# %%
montelux.integrate(lambda x: np.sin(x), (0, np.pi), relative_error=1e-10)

# %% [markdown]
# The digits in brackets are the error of the last digits shown. The second line says what it cost, which method did it
# and why it ended. The result is an object; these are the parts that you will need most:

# %%
r = montelux.integrate(lambda x: np.sin(x), (0, np.pi), relative_error=1e-10)
print("value          ", r.value)
print("standard_error ", r.standard_error)
print("converged      ", r.converged, "- the target was met, and there are no warnings")
print("warnings       ", r.warnings)
print("statistical    ", r.statistical, "- a deterministic rule: its error is an estimate, no standard deviation")

# %% [markdown]
# `if not r.converged: print(r)` is the line to write into programs.
#
# ## Integrands get many points at once
#
# The function is called with an array of points, so that NumPy's loops do the work: shape `(n,)` for one variable,
# `(n, d)` for more. It returns one value a point. A batch has about a thousand points; a call costs less than a
# microsecond beside your own arithmetic.

# %%
batches = 0


def f(x):
    global batches
    batches += 1
    return np.sin(x[:, 0]) * x[:, 1]


r = montelux.integrate(f, [(0, np.pi / 2), (0, 1)], "basic", evaluations=1_000_000, seed=1)
print(r)
print(f"about {round(r.evaluations / batches, -2):.0f} points a call")

# %% [markdown]
# A function that takes one point works with `batch=False`, slower:

# %%
print(montelux.integrate(lambda p: math.hypot(p[0], p[1]), [(0, 1), (0, 1)], relative_error=1e-8, batch=False))

# %% [markdown]
# The classic mistake is a sum over everything instead of over the coordinates of each point. Mistakes are answered
# by sentences:

# %%
try:
    montelux.integrate(lambda x: np.sum(x**2), [(0, 1), (0, 1)])
except montelux.Error as error:
    print(error)

# %% [markdown]
# ## Where: ranges, infinite ends, other regions
#
# Ends may be infinite. Regions that are not boxes are `Domain`s, with the measure that you expect: volume in a ball,
# area on a sphere.

# %%
gauss = montelux.integrate(lambda x: np.exp(-(x**2) / 2), (-np.inf, np.inf), relative_error=1e-10)
print(f"{gauss.value:.10f}, exactly {math.sqrt(2 * math.pi):.10f}")

ball = montelux.Domain.ball([0, 0, 0], 1)
inertia = montelux.integrate(lambda x: x[:, 0] ** 2 + x[:, 1] ** 2, ball, relative_error=1e-8)
print(f"{inertia.value:.8f}, exactly {8 * math.pi / 15:.8f}")

# %% [markdown]
# ## Which method?
#
# Without a name it is `auto`, which begins with cubature where that can win and goes over to adaptive sampling where it
# cannot. [docs/integration.md](../integration.md) says which method is for what. Here is a bump in four variables, exact
# value known, and the evaluations that each method takes to a relative error of one in a thousand, or five million:


# %%
def bump(x):
    return np.exp(-np.sum((x - 0.3) ** 2, axis=1) / (2 * 0.1**2))


cube = [(0, 1)] * 4
exact = (0.1 * math.sqrt(math.pi / 2) * (math.erf(0.7 / 0.1 / math.sqrt(2)) + math.erf(0.3 / 0.1 / math.sqrt(2)))) ** 4
runs = {}
for method in ("basic", "stratified", "quasi", "vegas", "adaptive", "cubature"):
    runs[method] = montelux.integrate(bump, cube, method, relative_error=1e-3, evaluations=5_000_000, seed=2)
    r = runs[method]
    print(
        f"{method:10} {r.evaluations:9} evaluations, {(r.value - exact) / r.standard_error:5.1f} errors off, {r.stop}"
    )

# %% [markdown]
# `history` has the run itself. The error of plain Monte Carlo falls as $1/\sqrt N$, for any integrand with a variance and
# any number of variables: ten times better costs a hundred times more. Quasi-random points fall faster, and adaptive
# methods begin lower, since they learn where the bump is.

# %%
figure, axes = plt.subplots()
styles = {"basic": (blue, "o"), "quasi": (green, "^"), "vegas": (purple, "s"), "adaptive": (orange, "D")}
for method, (colour, mark) in styles.items():
    h = runs[method].history
    known = np.isfinite(h.standard_error) & (h.standard_error > 0) & (h.evaluations > 500)
    axes.loglog(h.evaluations[known], h.standard_error[known] / exact, color=colour, marker=mark, ms=4, label=method)
n = np.array([1e3, 5e6])
axes.loglog(n, 4 / np.sqrt(n), "k:", label=r"slope $-\frac{1}{2}$")
axes.set(xlabel="evaluations", ylabel="relative standard error", title="Errors as the runs themselves report them")
axes.legend()
plt.show()

# %% [markdown]
# ## Is the error honest?
#
# An error bar is a promise: over many runs the truth lies within one of them in 68 % and within two in 95 %. Test it as you
# would test an instrument: repeat the measurement. 1000 seeds, 2000 evaluations each.


# %%
def z_scores(method, seeds, evaluations):
    results = (montelux.integrate(bump2, square, method, evaluations=evaluations, seed=s) for s in range(seeds))
    return np.array([(r.value - exact2) / r.standard_error for r in results])


def bump2(x):
    return np.exp(-np.sum((x - 0.3) ** 2, axis=1))


square = [(0, 1)] * 2
exact2 = (math.sqrt(math.pi) / 2 * (math.erf(0.7) + math.erf(0.3))) ** 2
z = {"basic": z_scores("basic", 1000, 2000), "quasi": z_scores("quasi", 1000, 2000)}
for method, scores in z.items():
    within = [100 * np.mean(np.abs(scores) <= k) for k in (1, 2)]
    print(f"{method}: within one error {within[0]:.1f} %, within two {within[1]:.1f} %, mean {scores.mean():.2f}")

# %%
figure, axes = plt.subplots(1, 2, figsize=(6.4, 2.9), sharey=True)
t = np.linspace(-4, 4, 200)
for a, (method, scores) in zip(axes, z.items()):
    a.hist(scores, bins=np.linspace(-4, 4, 33), density=True, color=blue, alpha=0.75)
    a.plot(t, np.exp(-t * t / 2) / math.sqrt(2 * math.pi), color=orange, lw=2, label="normal law")
    a.set(title=method, xlabel="(value − exact) / standard error")
axes[0].set(ylabel="density of 1000 seeds", ylim=(0, 0.52))
axes[0].legend(loc="upper right")
plt.show()

# %% [markdown]
# `quasi` estimates its error from the spread of a dozen randomised point sets, so that its scores follow Student's law:
# a little wider than the normal one. [docs/measurements/calibration-of-integration.md](../measurements/calibration-of-integration.md) has this table
# for every method on every test integrand.
#
# ## When the error cannot be trusted
#
# $\int_0^1 x^{-0.6}\,dx = 2.5$ exists, but the variance of $x^{-0.6}$ does not: no sample can tell the error of its mean.
# The library says what it can see. **Read the warnings**:

# %%
montelux.integrate(lambda x: x**-0.6, (0, 1), "quasi", evaluations=100_000)

# %% [markdown]
# Help it: sample where the integrand is large. With the density $p(x) = 0.4\,x^{-0.6}$ the ratio $f/p$ is constant, and
# every sample would be exact; a density that is merely as singular makes the variance finite, and the error means
# something again.

# %%
p = montelux.Distribution.beta(0.4, 1.4)  # x^-0.6 (1 - x)^0.4: as singular, otherwise different
print(montelux.integrate(lambda x: x**-0.6, (0, 1), montelux.Importance(p), evaluations=100_000, seed=1))
print(montelux.integrate(lambda x: x**-0.6, (0, 1), relative_error=1e-6))  # cubature copes with singular ends

# %% [markdown]
# What no method can see is a peak near which no point ever came. If you know where things happen, say so: by a range,
# a density or a map.
#
# ## Several integrals at once
#
# Return shape `(n, m)` and get m values *with their covariance*. Related quantities share their samples, and much of their
# noise cancels in ratios and differences. Here are partition functions $Z(\beta) = \int e^{-\beta H}$ of a particle at two
# temperatures; their ratio says how much the free energy changes.


# %%
def boltzmann(x):
    energy = x[:, 0] ** 4 + (x[:, 1] - x[:, 0]) ** 2
    return np.stack([np.exp(-energy), np.exp(-1.1 * energy)], axis=-1)


r = montelux.integrate(boltzmann, [(-3, 3), (-9, 9)], "stratified", evaluations=200_000, seed=4)
a, b = r.value
gradient = np.array([-b / a**2, 1 / a])  # of b / a
with_covariance = math.sqrt(gradient @ r.covariance @ gradient)
without = math.sqrt(gradient**2 @ r.standard_error**2)
print(f"ratio {b / a:.6f} +- {with_covariance:.6f}, exactly {1.1**-0.75:.6f}")
print(f"correlation of the two integrals {r.covariance[0, 1] / np.prod(r.standard_error):.3f}")
print(
    f"taken for independent, the error would be {without:.6f}, too large by a factor of {without / with_covariance:.1f}"
)

# %% [markdown]
# ## A physicist's integral: the Higgs boson and two photons
#
# A Higgs boson decays into two photons through a triangle of top quarks. With Feynman parameters and in units of the top
# quark's mass the scalar triangle is an integral over a simplex, $C_0 = \int_{x+y\le 1} \frac{dx\,dy}{1 - s\,x\,y}$ with
# $s = m_H^2/m_t^2$, and it has a closed form, $\frac{2}{s}\arcsin^2\frac{\sqrt s}{2}$.

# %%
s = (125.2 / 172.6) ** 2
triangle = montelux.integrate(
    lambda x: 1 / (1 - s * x[:, 0] * x[:, 1]), montelux.Domain.simplex(2), relative_error=1e-10
)
print(triangle)
print(f"closed form {2 / s * math.asin(math.sqrt(s) / 2) ** 2:.12f}")

# %% [markdown]
# ## A quant's integral: a call on a basket
#
# Six stocks follow correlated geometric Brownian motions; the option pays $\max(\text{mean} - K, 0)$ after a year. That is
# an integral over the unit cube of six uniforms, each made normal by inversion, which keeps low-discrepancy points what
# they are. All strikes are priced by the same samples: one vector-valued integral.

# %%
price = np.array([100, 95, 110, 90, 105, 100.0])
volatility = np.array([0.20, 0.25, 0.30, 0.35, 0.20, 0.15])
rate, sector = 0.03, np.arange(6) // 3
correlation = np.where(sector[:, None] == sector, 0.6, 0.3) + 0.4 * np.eye(6)
factor = np.linalg.cholesky(correlation) * volatility[:, None]
normal = montelux.Distribution.normal()
strikes = np.linspace(80, 120, 21)


def prices_in_a_year(u):
    return price * np.exp(rate - volatility**2 / 2 + normal.sample(u) @ factor.T)


def calls(u):
    mean = prices_in_a_year(u).mean(axis=1)
    return math.exp(-rate) * np.maximum(mean[:, None] - strikes, 0)


unit = montelux.Domain.unit_cube(6)
basket = montelux.integrate(calls, unit, "quasi", evaluations=60_000, seed=1)
middle = 10  # the strike 100
print(f"call at {strikes[middle]:.0f}: {basket.value[middle]:.4f} +- {basket.standard_error[middle]:.4f}")

# %% [markdown]
# The call on the *geometric* mean has a closed form (its logarithm is normal) and moves together with ours. As a control
# variate it takes away what the two have in common:


# %%
def geometric_call(u):
    return math.exp(-rate) * np.maximum(np.exp(np.log(prices_in_a_year(u)).mean(axis=1)) - 100, 0)


m = np.mean(np.log(price) + rate - volatility**2 / 2)
v = np.sum(factor.mean(axis=0) ** 2)
d = (m - math.log(100)) / math.sqrt(v)
black = math.exp(-rate) * (math.exp(m + v / 2) * normal.cdf(d + math.sqrt(v)) - 100 * normal.cdf(d))


def one_call(u):
    return calls(u)[:, middle]


plain = montelux.integrate(one_call, unit, "basic", evaluations=60_000, seed=1)
control = montelux.ControlVariate(geometric_call, [black])
controlled = montelux.integrate(one_call, unit, control, evaluations=60_000, seed=1)
print(f"plain Monte Carlo  {plain.value:.4f} +- {plain.standard_error:.4f}")
print(f"control variate    {controlled.value:.4f} +- {controlled.standard_error:.4f}")
print(f"Sobol' points      {basket.value[middle]:.4f} +- {basket.standard_error[middle]:.4f}")
print(f"the control is worth {(plain.standard_error / controlled.standard_error) ** 2:.0f} times the samples")

# %%
figure, axes = plt.subplots(2, sharex=True, height_ratios=(2, 1), figsize=(6.4, 4.2))
axes[0].plot(strikes, basket.value, color=blue, marker="o", ms=4)
axes[0].plot(
    strikes, np.maximum(price.mean() - strikes * math.exp(-rate), 0), color="black", ls=":", label="lower bound"
)
axes[0].set(ylabel="price of the call", title="21 strikes from one run")
axes[0].legend()
axes[1].plot(strikes, basket.standard_error, color=orange, marker="D", ms=4)
axes[1].set(xlabel="strike", ylabel="standard error", ylim=(0, None))
plt.show()

# %% [markdown]
# ## The same digits tomorrow
#
# A result depends on the integrand, the domain, the method, the budget and the seed, and **not on the number of threads**.
# Different seeds are independent runs.

# %%
one = montelux.integrate(bump, cube, "vegas", evaluations=50_000, seed=7, threads=1)
two = montelux.integrate(bump, cube, "vegas", evaluations=50_000, seed=7, threads=2)
other = montelux.integrate(bump, cube, "vegas", evaluations=50_000, seed=8)
print("equal, to the last bit:", one.value == two.value, "- another seed:", one.value == other.value)

# %% [markdown]
# ## Long runs: keep the state, go on later
#
# A checkpoint is written every minute and at the end. A killed run resumes from it and ends with **the same bits**;
# a finished run can be resumed for a smaller error. `to_dict` is ready for JSON.

# %%
for old in Path().glob("run.state*"):
    old.unlink()  # a run does not overwrite the state of another
first = montelux.integrate(bump, cube, "quasi", relative_error=1e-2, seed=3, checkpoint="run.state")
more = montelux.integrate(bump, cube, "quasi", relative_error=1e-3, seed=3, checkpoint="run.state", resume=True)
whole = montelux.integrate(bump, cube, "quasi", relative_error=1e-3, seed=3)
print(f"{first.evaluations} evaluations, then {more.evaluations} in all; as in one go: {more.value == whole.value}")
print(sorted(more.to_dict())[:6], "...")

# %% [markdown]
# ## Where next
#
# - [sampling.ipynb](sampling.ipynb): random variables, point sets, importance sampling with several densities, Metropolis
# - [rendering.ipynb](rendering.ipynb): pictures are a million integrals, each with its error
# - [docs/integration.md](../integration.md): every method, what its error means, what each warning says
# - [docs/measurements/integration-bench.md](../measurements/integration-bench.md): the methods beside GSL, cubature and vegas
