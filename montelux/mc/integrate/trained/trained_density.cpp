#include "montelux/mc/integrate/trained/trained_density.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "montelux/mc/integrate/domain_probe.h"
#include "montelux/mc/integrate/whole_file.h"
#include "montelux/mc/math/error.h"

namespace montelux {
namespace {

constexpr std::string_view density_file = "trained density";
constexpr std::uint64_t density_version = 1;
// More are no density that training makes.
constexpr std::uint64_t most_dimensions = 1 << 16;
constexpr double domain_rounding = 1e-9;

bool agree(const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](double x, double y) {
        return std::abs(x - y) <= domain_rounding * (std::abs(x) + std::abs(y)) + 1e-300;
    });
}

Domain load_domain(StateReader& state, const Domain* given) {
    const std::string description = state.get_text();
    const std::vector<double> ends = state.get_doubles(), values = state.get_doubles();
    std::optional<Domain> domain;
    if (given != nullptr) {
        domain = *given;
    } else if (ends.empty()) {
        throw Error("holds a density on a domain that a file cannot hold (" + description +
                    "); expected that domain beside the file");
    } else {
        if (ends.size() % 2 != 0 || ends.size() / 2 > most_dimensions)
            throw Error("holds a domain without ranges");
        std::vector<Range> ranges;
        for (std::size_t i = 0; i < ends.size(); i += 2) ranges.push_back({ends[i], ends[i + 1]});
        domain = Domain(std::move(ranges));
    }
    if (!agree(DomainProbe(*domain).numbers(), values))
        throw Error("holds a density on another domain (" + description + ") than the one given (" +
                    domain->description() + ")");
    return *domain;
}

} // namespace

TrainedDensity::TrainedDensity(std::shared_ptr<const UnitDensity> unit, Domain domain)
    : unit_(std::move(unit)), domain_(std::move(domain)) {
    if (unit_->dimensions() != domain_.uniforms())
        throw Error("TrainedDensity", "the density has " + std::to_string(unit_->dimensions()) +
                                          " dimensions, but the domain (" + domain_.description() +
                                          ") takes " + std::to_string(domain_.uniforms()));
}

void TrainedDensity::pdf(const PointBatch& x, std::span<double> density) const {
    if (x.dimensions() != domain_.dimensions())
        throw Error("TrainedDensity", "points of " + std::to_string(x.dimensions()) +
                                          " coordinates were given; expected " +
                                          std::to_string(domain_.dimensions()));
    PointBuffer u(x.count(), domain_.uniforms());
    std::vector<double> volume(x.count(), 1.0);
    domain_.inverse(x, u, volume);
    unit_->pdf(u, density);
    for (std::size_t i = 0; i < volume.size(); ++i)
        density[i] = std::isfinite(volume[i]) && density[i] > 0 ? density[i] / volume[i] : 0;
}

double TrainedDensity::pdf(std::span<const double> x) const {
    double density = 0;
    pdf(PointBatch(x.data(), 1, static_cast<int>(x.size()), 1), {&density, 1});
    return density;
}

std::vector<std::uint64_t> TrainedDensity::words() const {
    StateWriter state;
    state.put(density_version);
    state.put(static_cast<std::uint64_t>(notes_.size()));
    for (const auto& [name, text] : notes_) {
        state.put(std::string_view(name));
        state.put(std::string_view(text));
    }
    state.put(std::string_view(domain_.description()));
    std::vector<double> ends;
    for (const Range& range : domain_.ranges()) ends.insert(ends.end(), {range.lower, range.upper});
    state.put(ends);
    state.put(DomainProbe(domain_).numbers());
    unit_->save(state);
    const auto all = state.words();
    return {all.begin(), all.end()};
}

namespace {

std::map<std::string, std::string> load_notes(StateReader& state) {
    if (state.get_word() != density_version) throw Error("is of another version of the format");
    std::map<std::string, std::string> notes;
    for (std::uint64_t n = state.get_word(); n > 0; --n) {
        std::string name = state.get_text();
        notes.insert_or_assign(std::move(name), state.get_text());
    }
    return notes;
}

} // namespace

TrainedDensity TrainedDensity::from_words(std::vector<std::uint64_t> words, const Domain* domain) {
    StateReader state(std::move(words));
    std::map<std::string, std::string> notes = load_notes(state);
    Domain region = load_domain(state, domain);
    auto unit = std::make_shared<const UnitDensity>(UnitDensity::load(state, region.uniforms()));
    if (!state.at_end()) throw Error("holds more than a density");
    TrainedDensity density(std::move(unit), std::move(region));
    density.set_notes(std::move(notes));
    return density;
}

void TrainedDensity::save(const std::string& path) const {
    StateWriter state;
    for (std::uint64_t word : words()) state.put(word);
    write_state(path, density_file, state);
}

std::map<std::string, std::string> TrainedDensity::notes_of(const std::string& path) {
    return read_whole_file(path, density_file, load_notes);
}

TrainedDensity TrainedDensity::load(const std::string& path) {
    return read_whole_file(path, density_file, [](StateReader& state) { return from_words(state.rest()); });
}

TrainedDensity TrainedDensity::load(const std::string& path, const Domain& domain) {
    return read_whole_file(path, density_file,
                           [&](StateReader& state) { return from_words(state.rest(), &domain); });
}

} // namespace montelux
