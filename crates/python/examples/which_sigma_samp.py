"""Which sigma_samp for a cloud of your own: variance and efficiency of two estimators, in closed form and drawn.

    pip install fairflight matplotlib
    python which_sigma_samp.py [cloud.png]

The cloud is a stratocumulus as an aircraft may have measured it, on a slant path: extinction grows with height as water condenses, dry air from above has eaten holes into
its top. Ratio tracking meets it as it is; residual ratio tracking knows its mean and tracks what is left.
"""

import sys

import fairflight
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Extinction [1/km] along 0.8 km, every 10 m.
s = np.linspace(0.0, 0.8, 81)
adiabatic = 12.0 * np.cbrt(s / 0.8) ** 2
holes = 1.0 - 0.7 * np.exp(-(((s - 0.62) / 0.05) ** 2)) - 0.5 * np.exp(-(((s - 0.35) / 0.03) ** 2))
sigma_t = adiabatic * holes
cloud = fairflight.Profile.linear(s, sigma_t)


def integral_of_square(values):
    """The integral of the square of what is linear between these values."""
    a, b = values[:-1], values[1:]
    return np.sum(np.diff(s) * (a * a + a * b + b * b) / 3)


nothing = {"kind": "woodcock", "majorant": cloud.majorant}
thickness = fairflight.moments(cloud, nothing).optical_thickness
mean = thickness / cloud.length
entrants = {
    "ratio tracking": {"kind": "none"},
    "residual ratio tracking, control = mean": {"kind": "constant", "sigma_main": mean},
}
rates = np.geomspace(0.2, 10.0, 70) * cloud.majorant
marks = rates[4::14]

figure, (profile, variance, cost) = plt.subplots(1, 3, figsize=(13.5, 4.2), layout="constrained")
profile.fill_between(s, sigma_t, alpha=0.3)
profile.plot(s, sigma_t)
profile.axhline(mean, linestyle=":", color="black", linewidth=1)
profile.annotate(f"mean {mean:.2f}", (0.01, mean), xytext=(0, 3), textcoords="offset points")
profile.set(xlabel="s [km]", ylabel=r"$\sigma_t$ [1/km]", title=f"cloud, optical thickness {thickness:.2f}", ylim=(0, None))

for name, control in entrants.items():
    at = [{"kind": "double_particle", "sigma_samp": rate, "control": control} for rate in rates]
    laws = [fairflight.moments(cloud, estimator) for estimator in at]
    relative = np.array([law.variance / law.mean**2 for law in laws])
    price = relative * np.array([law.lookups for law in laws])
    (line,) = variance.plot(rates, relative, label=name)
    cost.plot(rates, price, color=line.get_color())
    # As sigma_samp grows, exp(integral of (sigma_t - control)^2 / sigma_samp) - 1 times sigma_samp * length comes down to this.
    limit = cloud.length * integral_of_square(sigma_t - control.get("sigma_main", 0.0))
    cost.axhline(limit, linestyle="--", linewidth=1, color=line.get_color())
    for rate in marks:
        estimator = {"kind": "double_particle", "sigma_samp": rate, "control": control}
        drawn = fairflight.draw(cloud, estimator, samples=50_000, seed=1)
        law = fairflight.moments(cloud, estimator)
        verdict = fairflight.judge(drawn.values, law.mean, central=law.central)
        # Hollow: not testable with so few.
        fill = line.get_color() if verdict.sound else "none"
        variance.plot(rate, drawn.variance / law.mean**2, "o", color=line.get_color(), markerfacecolor=fill)
        assert verdict.sound is not False, verdict.reason
    at_majorant = np.interp(cloud.majorant, rates, price)
    print(f"{name}: variance x look-ups {at_majorant:.1f} at the majorant, {limit:.2f} at best")

for axes, what in ((variance, "variance"), (cost, "variance x look-ups")):
    axes.set(xscale="log", yscale="log", xlabel=r"$\sigma_\mathrm{samp}$ [1/km]", title=f"relative {what} of one estimate")
    axes.axvline(cloud.majorant, linestyle=":", color="black", linewidth=1)
    axes.grid(alpha=0.3, which="both")
    axes.set_xticks([3, 10, 30, 100], ["3", "10", "30", "100"])
    axes.xaxis.set_minor_formatter("")
variance.annotate("majorant", (cloud.majorant, 0.5), xycoords=("data", "axes fraction"), rotation=90, xytext=(3, 0), textcoords="offset points")
cost.annotate(r"dashed: limit as $\sigma_\mathrm{samp}$ grows", (0.45, 0.93), xycoords="axes fraction", fontsize="small")
variance.legend(title="curves in closed form, marks drawn\n(hollow: not testable with so few)", fontsize="small", title_fontsize="small")

name = sys.argv[1] if len(sys.argv) > 1 else "which_sigma_samp.png"
figure.savefig(name, dpi=110)
print(f"wrote {name}")
