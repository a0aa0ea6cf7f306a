#include "app/integrate/integration_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "montelux/mc/device/device_function.h"

namespace montelux::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json numbers(std::span<const double> values) {
    Json out = Json::array();
    for (double v : values) out.push_back(number(v));
    return out;
}

Json matrix(const std::vector<double>& values, std::size_t columns) {
    Json out = Json::array();
    for (std::size_t begin = 0; begin + columns <= values.size(); begin += columns)
        out.push_back(numbers(std::span(values).subspan(begin, columns)));
    return out;
}

// What follows the values, in the library's own words.
std::string report_rest(const IntegrationResult& r) {
    const std::string all = to_string(r);
    std::size_t rest = 0;
    for (std::size_t c = 0; c < r.value.size(); ++c) rest = all.find('\n', rest) + 1;
    std::string text = all.substr(rest) + "\n";
    if (!r.statistical)
        text += "the error is an estimate by a deterministic rule, not a standard deviation\n";
    return text;
}

} // namespace

std::string report_text(const IntegrationTask& task, const IntegrationResult& r) {
    std::string text;
    for (std::size_t c = 0; c < r.value.size(); ++c) {
        Estimate one = r.estimate(static_cast<int>(c));
        one.non_finite = 0; // reported by a warning
        if (r.value.size() > 1) text += task.integrand.names[c] + ": ";
        text += to_string(one) + "\n";
    }
    return text + report_rest(r);
}

std::string report_text(const LogIntegrationResult& r) {
    return "log Z = " + to_string(Estimate{r.log_value, r.log_error}) + "\n" + report_rest(r.relative);
}

Json report_json(const IntegrationTask& task, const IntegrationResult& r) {
    const bool scalar = task.integrand.count() == 1;
    auto entry = [scalar](const std::vector<double>& values) {
        if (!scalar) return numbers(values);
        return values.empty() ? Json(nullptr) : number(values.front());
    };
    Json out;
    out["value"] = entry(r.value);
    out["standard_error"] = entry(r.standard_error);
    out["covariance"] = r.covariance.empty() ? Json(nullptr)
                        : scalar             ? number(r.covariance.front())
                                             : matrix(r.covariance, r.value.size());
    out["statistical"] = r.statistical;
    out["evaluations"] = r.evaluations;
    out["method"] = r.method;
    out["reason"] = r.reason;
    const bool compared = r.degrees_of_freedom > 0;
    out["chi_squared"] = compared ? number(r.chi_squared) : Json(nullptr);
    out["degrees_of_freedom"] = r.degrees_of_freedom;
    out["chi_squared_per_degree"] = compared ? number(r.chi_squared_per_degree()) : Json(nullptr);
    out["p_value"] = compared ? number(r.p_value) : Json(nullptr);
    out["converged"] = r.converged();
    out["stop"] = to_string(r.stop);
    out["notes"] = r.notes;
    out["warnings"] = r.warnings;
    out["non_finite"] = r.non_finite;
    out["first_non_finite_point"] =
        r.first_non_finite_point.empty() ? Json(nullptr) : numbers(r.first_non_finite_point);
    out["seconds"] = number(r.seconds);
    out["seed"] = task.options.seed;
    out["variables"] = task.variables;
    out["formulas"] = task.integrand.names;
    out["domain"] = task.domain.description();
    if (task.integrand.compiled) out["device"] = task.integrand.compiled->device()->description();
    out["history"] = Json::array();
    for (const IterationRecord& h : r.history) {
        Json record;
        record["evaluations"] = h.evaluations;
        record["value"] = number(h.value);
        record["standard_error"] = number(h.standard_error);
        record["seconds"] = number(h.seconds);
        out["history"].push_back(std::move(record));
    }
    return out;
}

Json report_json(const IntegrationTask& task, const LogIntegrationResult& r) {
    Json out;
    out["log_value"] = number(r.log_value);
    out["log_error"] = number(r.log_error);
    out["log_reference"] = number(r.log_reference);
    out.update(report_json(task, r.relative));
    // In a unit of their own, they would be taken for Z.
    for (const char* relative : {"value", "standard_error", "covariance"}) out.erase(relative);
    return out;
}

} // namespace montelux::app
