// The integral of sin x over [0, pi/2], which is 1, with x drawn from the density 8 x / pi^2.
#include <cmath>
#include <iostream>
#include <montelux/mc/stats/estimate.h>
#include <montelux/mc/warp/linear.h>
#include <random>

int main() {
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> uniform;
    const double b = std::acos(-1.0) / 2;

    montelux::RunningMoments moments;
    for (int i = 0; i < 100000; ++i) {
        const double t = montelux::sample_linear(uniform(engine), 0.0, 1.0); // density 2t on [0, 1)
        moments.add(std::sin(b * t) * b / montelux::linear_pdf(t, 0.0, 1.0));
    }
    std::cout << "integral of sin x over [0, pi/2] = " << montelux::Estimate::from_moments(moments) << "\n";
}
