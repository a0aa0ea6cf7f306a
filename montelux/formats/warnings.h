// Warnings: the messages of a reader that do not stop it: ignored parameters, differences from the format.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

namespace montelux {

// Messages in order of occurrence, each kept once. At most `max_messages` are kept, so that a broken file
// cannot exhaust the memory; `left_out` counts the others.
class Warnings {
  public:
    static constexpr std::size_t max_messages = 1000;

    void add(std::string_view where, std::string_view sentence) {
        std::string message =
            where.empty() ? std::string(sentence) : std::string(where) + ": " + std::string(sentence);
        if (messages_.size() >= max_messages) {
            ++left_out_;
            return;
        }
        if (seen_.insert(message).second) messages_.push_back(std::move(message));
    }
    const std::vector<std::string>& messages() const { return messages_; }
    std::size_t left_out() const { return left_out_; }

  private:
    std::vector<std::string> messages_;
    std::unordered_set<std::string> seen_;
    std::size_t left_out_ = 0;
};

} // namespace montelux
