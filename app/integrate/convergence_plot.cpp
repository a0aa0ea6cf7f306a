#include "app/integrate/convergence_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "montelux/mc/io/file.h"

namespace montelux::app {
namespace {

std::string text(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string text(const char* format, ...) {
    char buffer[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    return buffer;
}

std::string escaped(const std::string& plain) {
    std::string out;
    for (char c : plain) {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else
            out += c >= ' ' || c < 0 ? c : ' ';
    }
    return out;
}

// One axis: numbers to places on the picture, linear or logarithmic.
struct Axis {
    double low, high;  // numbers
    double begin, end; // places in pixels
    bool logarithmic;

    double operator()(double v) const {
        const double t = logarithmic ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
        return begin + std::clamp(t, -100.0, 100.0) * (end - begin);
    }
};

struct Tick {
    double value;
    std::string label; // empty for a mark between
};

// 10 with raised digits, which every viewer of SVG places alike.
std::string power_of_ten(int exponent) {
    static constexpr std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string label = exponent < 0 ? "10⁻" : "10";
    for (char digit : std::to_string(std::abs(exponent)))
        label += raised[static_cast<std::size_t>(digit - '0')];
    return label;
}

// Powers of ten, labelled so that at most eight labels stand, and 2 to 9 times them where there is room.
std::vector<Tick> logarithmic_ticks(double low, double high) {
    std::vector<Tick> ticks;
    const int first = static_cast<int>(std::floor(std::log10(low))),
              last = static_cast<int>(std::ceil(std::log10(high)));
    const int every = std::max(1, (last - first + 7) / 8);
    for (int e = first; e <= last; ++e)
        for (int digit = 1; digit < 10; ++digit) {
            const double v = digit * std::pow(10.0, e);
            if (v < low * (1 - 1e-9) || v > high * (1 + 1e-9) || (digit > 1 && last - first > 8)) continue;
            // Where there are few decades, the marks between need labels too.
            const bool few = high / low < 50;
            std::string label;
            if (digit == 1 && (e - first) % every == 0)
                label = power_of_ten(e);
            else if (few && (digit == 2 || digit == 5))
                label = std::to_string(digit) + "·" + power_of_ten(e);
            ticks.push_back({v, std::move(label)});
        }
    return ticks;
}

// About five round steps of 1, 2 or 5 times a power of ten.
std::vector<Tick> linear_ticks(double low, double high) {
    const double rough = (high - low) / 5, power = std::pow(10.0, std::floor(std::log10(rough)));
    const double step = power * (rough / power < 1.5   ? 1
                                 : rough / power < 3.5 ? 2
                                 : rough / power < 7.5 ? 5
                                                       : 10);
    std::vector<Tick> ticks;
    const double largest = std::max(std::abs(low), std::abs(high));
    // Enough digits to distinguish neighbours.
    const int digits = std::clamp(static_cast<int>(std::ceil(std::log10(largest / step))) + 1, 1, 17);
    for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
        const double v = k == 0 ? 0 : k * step;
        ticks.push_back({v, text("%.*g", digits, v)});
    }
    return ticks;
}

constexpr double width = 720, left = 110, right = 700;

class Svg {
  public:
    Svg() {
        svg_ = text(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"640\" viewBox=\"0 0 %g 640\" "
            "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" "
            "fill=\"white\"/>\n",
            width, width);
    }
    void label(double x, double y, const std::string& content, const char* attributes = "") {
        svg_ += text("<text x=\"%.2f\" y=\"%.2f\" %s>", x, y, attributes) + content + "</text>\n";
    }
    void line(double x0, double y0, double x1, double y1, const char* attributes) {
        svg_ +=
            text("<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" %s/>\n", x0, y0, x1, y1, attributes);
    }
    void path(const std::string& d, const char* attributes) {
        svg_ += "<path d=\"" + d + "\" " + attributes + "/>\n";
    }
    // Shows what follows within the panel alone, until end_clip().
    void begin_clip(const char* name, const Axis& x, const Axis& y) {
        svg_ += text(
            "<clipPath id=\"%s\"><rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\"/></clipPath>\n",
            name, x.begin, y.end, x.end - x.begin, y.begin - y.end);
        svg_ += text("<g clip-path=\"url(#%s)\">\n", name);
    }
    void end_clip() { svg_ += "</g>\n"; }
    // The frame, grid and numbers of one panel.
    void frame(const Axis& x, const Axis& y, const std::vector<Tick>& x_ticks,
               const std::vector<Tick>& y_ticks) {
        for (const Tick& t : x_ticks) {
            const bool named = !t.label.empty();
            line(x(t.value), y.begin, x(t.value), named ? y.end : y.begin - 4,
                 named ? "stroke=\"#dddddd\"" : "stroke=\"#888888\"");
            if (named) label(x(t.value), y.begin + 18, t.label, "text-anchor=\"middle\"");
        }
        for (const Tick& t : y_ticks) {
            const bool named = !t.label.empty();
            line(x.begin, y(t.value), named ? x.end : x.begin + 4, y(t.value),
                 named ? "stroke=\"#dddddd\"" : "stroke=\"#888888\"");
            if (named) label(x.begin - 8, y(t.value) + 4, t.label, "text-anchor=\"end\"");
        }
        svg_ += text("<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"none\" "
                     "stroke=\"#444444\"/>\n",
                     x.begin, y.end, x.end - x.begin, y.begin - y.end);
    }
    void vertical_label(double x, double y, const std::string& content) {
        svg_ += text("<text transform=\"translate(%.2f %.2f) rotate(-90)\" text-anchor=\"middle\">", x, y) +
                content + "</text>\n";
    }
    std::string finished() { return svg_ + "</svg>\n"; }

  private:
    std::string svg_;
};

// Points as "M x y L x y ...".
template <typename Records, typename Y>
std::string polyline(const Records& records, const Axis& x, const Axis& axis, const Y& y) {
    std::string d;
    for (const auto& r : records)
        d += text("%s%.2f %.2f", d.empty() ? "M" : " L", x(static_cast<double>(r.evaluations)), axis(y(r)));
    return d;
}

std::string band(const std::vector<IterationRecord>& records, const Axis& x, const Axis& axis,
                 double sigmas) {
    std::string d =
        polyline(records, x, axis, [&](const auto& r) { return r.value + sigmas * r.standard_error; });
    const std::vector<IterationRecord> back(records.rbegin(), records.rend());
    std::string lower =
        polyline(back, x, axis, [&](const auto& r) { return r.value - sigmas * r.standard_error; });
    if (!lower.empty()) lower[0] = 'L';
    return d + " " + lower + " Z";
}

// The part of a run in which numbers can be drawn.
std::vector<IterationRecord> drawable(const IntegrationResult& result) {
    std::vector<IterationRecord> records;
    for (const IterationRecord& r : result.history)
        if (r.evaluations > 0 && std::isfinite(r.value) && std::isfinite(r.standard_error))
            records.push_back(r);
    return records;
}

void draw_value(Svg& picture, const std::vector<IterationRecord>& records, const Axis& x,
                const std::vector<Tick>& x_ticks) {
    // The later part sets the scale: the first steps may be far off.
    double low = INFINITY, high = -INFINITY;
    for (std::size_t i = records.size() / 4; i < records.size(); ++i) {
        const IterationRecord& r = records[i];
        low = std::min(low, r.value - 2.2 * r.standard_error);
        high = std::max(high, r.value + 2.2 * r.standard_error);
    }
    // No narrower than a billionth of the value, so that the numbers at the axis differ.
    const double margin =
        std::max({0.05 * (high - low), 1e-9 * std::max(std::abs(low), std::abs(high)), 1e-300});
    const Axis y{low - margin, high + margin, 320, 44, false};
    picture.begin_clip("bands", x, y);
    picture.path(band(records, x, y, 2), "fill=\"#dbe9f6\"");
    picture.path(band(records, x, y, 1), "fill=\"#a9cbe8\"");
    picture.end_clip();
    picture.frame(x, y, x_ticks, linear_ticks(y.low, y.high));
    picture.begin_clip("values", x, y);
    picture.path(polyline(records, x, y, [](const auto& r) { return r.value; }),
                 "fill=\"none\" stroke=\"#08519c\" stroke-width=\"1.6\"");
    picture.end_clip();
    const double final_value = records.back().value;
    picture.line(x.begin, y(final_value), x.end, y(final_value),
                 "stroke=\"#444444\" stroke-dasharray=\"2 3\"");
    picture.label(x.end - 6, 60, "bands: one and two standard errors",
                  "text-anchor=\"end\" fill=\"#444444\"");
    picture.vertical_label(22, 182, "value");
}

void draw_error(Svg& picture, const std::vector<IterationRecord>& records, const Axis& x,
                const std::vector<Tick>& x_ticks, bool statistical) {
    std::vector<IterationRecord> positive;
    for (const IterationRecord& r : records)
        if (r.standard_error > 0) positive.push_back(r);
    const double top = 372, bottom = 584;
    if (positive.empty()) {
        picture.label(0.5 * (x.begin + x.end), 0.5 * (top + bottom), "the error is zero",
                      "text-anchor=\"middle\"");
        return;
    }
    // Through the first error whose number of evaluations is no longer tiny: the reference falls from there.
    const IterationRecord anchor = positive[positive.size() / 4];
    auto reference = [&](double n) {
        return anchor.standard_error * std::sqrt(static_cast<double>(anchor.evaluations) / n);
    };
    double low = reference(x.high), high = reference(x.low);
    for (const IterationRecord& r : positive) {
        low = std::min(low, r.standard_error);
        high = std::max(high, r.standard_error);
    }
    const Axis y{low / 1.3, high * 1.3, bottom, top, true};
    picture.frame(x, y, x_ticks, logarithmic_ticks(y.low, y.high));
    picture.path(polyline(positive, x, y, [](const auto& r) { return r.standard_error; }),
                 "fill=\"none\" stroke=\"#b2182b\" stroke-width=\"1.6\"");
    picture.line(x(x.low), y(reference(x.low)), x(x.high), y(reference(x.high)),
                 "stroke=\"#222222\" stroke-dasharray=\"6 4\"");
    picture.label(x.end - 6, top + 16, "dashed: falls as 1/√N", "text-anchor=\"end\" fill=\"#444444\"");
    picture.vertical_label(22, 0.5 * (top + bottom), statistical ? "standard error" : "error estimate");
}

} // namespace

std::string convergence_svg(const std::string& title, const IntegrationResult& result) {
    Svg picture;
    const std::vector<IterationRecord> records = drawable(result);
    picture.label(left, 24, escaped(title), "font-size=\"14\"");
    if (records.empty()) {
        picture.label(0.5 * width, 320, "no step of the run has a value with a finite error",
                      "text-anchor=\"middle\"");
        return picture.finished();
    }
    const auto first = static_cast<double>(records.front().evaluations);
    const auto last = static_cast<double>(records.back().evaluations);
    // A run of one step is a point; half a decade on either side gives it an axis.
    const bool point = !(last > first);
    const Axis x{point ? first / 3 : first, point ? last * 3 : last, left, right, true};
    const std::vector<Tick> x_ticks = logarithmic_ticks(x.low, x.high);
    draw_value(picture, records, x, x_ticks);
    draw_error(picture, records, x, x_ticks, result.statistical);
    picture.label(0.5 * (left + right), 626, "evaluations N", "text-anchor=\"middle\"");
    return picture.finished();
}

void write_convergence_plot(const std::string& path, const IntegrationTask& task,
                            const IntegrationResult& result) {
    const std::string title = task.integrand.names.front() + " by " + result.method + ": " +
                              (result.value.empty() ? "?" : to_string(result.estimate()));
    const std::string svg = convergence_svg(title, result);
    AtomicFile file(path);
    file.write(svg.data(), svg.size());
    file.commit();
}

} // namespace montelux::app
