// One line of progress on standard error: redrawn in place on a terminal, a line now and then elsewhere.
#pragma once

#include <string>
#include <vector>

namespace montelux::app {

class ProgressLine {
  public:
    explicit ProgressLine(bool quiet);

    // Whether it is time for another line; `seconds` is the time since the work began.
    bool due(double seconds);
    // `what` precedes the text where there is no terminal. On one, what is beyond its width is cut off.
    void show(const char* what, const std::string& text);
    // Ends the line, if one is being drawn.
    void finish();

    bool on_terminal() const { return terminal_; }

  private:
    bool quiet_, terminal_, drawn_ = false;
    double last_ = 0;
};

// Columns of the terminal behind standard error; where it does not say, $COLUMNS, else 80.
int terminal_columns();

struct LinePart {
    std::string text;
    int rank = 0; // parts of high rank give way first
};
// The texts of as many parts as `columns` hold, joined by ", ". The part of the lowest rank is always there.
std::string joined_to_fit(std::vector<LinePart> parts, std::size_t columns);
// "[####......] ", of at most `columns`; nothing where a bar would be too short to tell.
std::string progress_bar(double share, std::size_t columns);

// 75 -> "1:15", 3700 -> "1:01:40", 2.5 -> "2.5 s"
std::string duration_text(double seconds);
// 0.0213 -> "2.13 %"; infinite or unknown -> "?"
std::string percent_text(double fraction);
// 1234567 -> "1.23 M"
std::string count_text(double count);

} // namespace montelux::app
