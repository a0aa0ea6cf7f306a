// The integral of sin x over [0, pi/2], which is 1, with x drawn from the density 8 x / pi^2.
#include <cmath>
#include <iostream>
#include <montelux/mc/dist/families.h>
#include <montelux/mc/integrate/integrate.h>
#include <montelux/mc/integrate/techniques/importance.h>
#include <numbers>

int main() {
    using namespace montelux;
    const double b = std::numbers::pi / 2;
    const IntegrationResult r = integrate([](double x) { return std::sin(x); }, Domain::interval(0, b),
                                          Importance{LinearDistribution(0, b)}, {.relative_error = 1e-4});
    std::cout << "integral of sin x over [0, pi/2] = " << r << "\n";
}
