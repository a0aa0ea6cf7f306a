#include "montelux/mc/math/nearest_name.h"

#include <algorithm>
#include <array>
#include <vector>

namespace montelux {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Optimal string alignment distance (Damerau 1964, restricted form), row by row.
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        before = previous;
        previous = row;
    }
    return previous[b.size()];
}

struct Synonym {
    std::string_view other, ours;
};

// Names that earlier versions and other programs have for settings of renders and integrals.
constexpr std::array<Synonym, 9> synonyms{{{"samples", "spp"},
                                           {"samples-per-pixel", "spp"},
                                           {"max-samples", "max-spp"},
                                           {"spp-max", "max-spp"},
                                           {"samples-max", "max-spp"},
                                           {"seconds", "time"},
                                           {"max-time", "time"},
                                           {"time-limit", "time"},
                                           {"timeout", "time"}}};

// Options have two dashes before them and dashes within, arguments of functions have underscores.
bool same_words(std::string_view a, std::string_view b) {
    auto plain = [](char c) { return c == '_' ? '-' : c; };
    if (a.starts_with("--")) a.remove_prefix(2);
    return std::ranges::equal(a, b, {}, plain);
}

} // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> candidates) {
    if (name.size() > 64) return {};
    for (const Synonym& s : synonyms)
        if (same_words(name, s.other))
            for (const std::string_view candidate : candidates)
                if (same_words(candidate, s.ours)) return candidate;
    std::string_view best;
    std::size_t best_edits = std::max<std::size_t>(2, name.size() / 3) + 1;
    for (std::string_view candidate : candidates) {
        std::size_t n = edits(name, candidate);
        // A name that is replaced altogether is no misspelling.
        if (n < best_edits && n < std::max(name.size(), candidate.size())) {
            best = candidate;
            best_edits = n;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates) {
    std::string_view near = nearest_name(name, candidates);
    return near.empty() ? std::string() : " (did you mean '" + std::string(near) + "'?)";
}

} // namespace montelux
