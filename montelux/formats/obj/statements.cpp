#include "montelux/formats/obj/statements.h"

#include <cstring>

#include "montelux/formats/number.h"
#include "montelux/scene/build/quoted.h"

namespace montelux::obj {

float Words::number(std::string_view what) {
    skip_spaces();
    float value = 0;
    const NumberResult r = parse_number(p_, end_, value);
    if (r.status == NumberStatus::ok && (r.end == end_ || is_space(*r.end))) {
        p_ = r.end;
        return value;
    }
    const std::string_view word = next();
    if (word.empty()) error("the line ends early; expected " + std::string(what));
    if (r.status == NumberStatus::out_of_range)
        error(quoted(word) + " is beyond what single-precision numbers hold; expected " + std::string(what));
    error("read " + quoted(word) + "; expected " + std::string(what));
}

std::optional<float> Words::find_number() {
    skip_spaces();
    float value = 0;
    const NumberResult r = parse_number(p_, end_, value);
    if (r.status != NumberStatus::ok || (r.end != end_ && !is_space(*r.end))) return std::nullopt;
    p_ = r.end;
    return value;
}

std::string_view Statements::take_line() {
    const auto* stop = static_cast<const char*>(std::memchr(p_, '\n', static_cast<std::size_t>(end_ - p_)));
    const char* end = stop != nullptr ? stop : end_;
    std::string_view text(p_, static_cast<std::size_t>(end - p_));
    p_ = stop != nullptr ? stop + 1 : end_;
    ++lines_;
    if (text.ends_with('\r')) text.remove_suffix(1);
    return text;
}

bool Statements::next() {
    while (p_ != end_) {
        std::string_view text = take_line();
        line_ = lines_;
        if (text.ends_with('\\')) {
            joined_.clear();
            for (; text.ends_with('\\'); text = p_ != end_ ? take_line() : std::string_view())
                joined_.append(text.substr(0, text.size() - 1)).push_back(' ');
            text = joined_.append(text);
        }
        words_ = Words(text, file_, line_);
        keyword_ = words_.next();
        if (!keyword_.empty() && keyword_[0] != '#') return true;
    }
    return false;
}

} // namespace montelux::obj
