#include "test/house/house.h"
#include <algorithm>
#include <array>
#include <cctype>

namespace montelux::house {

namespace {

// A word of a line, with what stands before and after it.
struct Word {
    std::string text;
    std::string before; // the word before it, where only spaces, '&', '*' and '>' lie between; else empty
    char previous = ' ', next = ' ';
    std::size_t line = 0; // from 1
    bool first = false;   // on its line, at its very beginning
};

bool is_word_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// A line without comment and without what stands in quotation marks.
std::string code_of(const std::string& line) {
    std::string code;
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (quote != 0) {
            if (line[i] == '\\')
                ++i;
            else if (line[i] == quote)
                quote = 0;
            continue;
        }
        if (line.compare(i, 2, "//") == 0) break;
        const bool separates_digits = line[i] == '\'' && i > 0 && is_word_character(line[i - 1]);
        if (line[i] == '"' || (line[i] == '\'' && !separates_digits)) quote = line[i];
        code += line[i];
    }
    return code;
}

std::vector<Word> words_of(const SourceFile& file) {
    std::vector<Word> words;
    for (std::size_t l = 0; l < file.lines.size(); ++l) {
        const std::string code = code_of(file.lines[l]);
        if (code.starts_with('#')) continue;
        std::string before;
        for (std::size_t i = 0; i < code.size();) {
            if (!is_word_character(code[i])) {
                if (std::string_view(" &*>").find(code[i]) == std::string_view::npos) before.clear();
                ++i;
                continue;
            }
            std::size_t end = i;
            while (end < code.size() && is_word_character(code[end])) ++end;
            Word word{code.substr(i, end - i),
                      before,
                      i > 0 ? code[i - 1] : ' ',
                      end < code.size() ? code[end] : ' ',
                      l + 1,
                      i == 0};
            before = word.text;
            words.push_back(std::move(word));
            i = end;
        }
    }
    return words;
}

bool declares_a_type(const std::string& word) {
    return word == "struct" || word == "class" || word == "enum" || word == "concept" || word == "using" ||
           word == "typename";
}

// Words between which nothing is declared.
bool is_keyword(const std::string& word) {
    constexpr std::array keywords{"return", "throw", "else", "in",  "case", "new",
                                  "delete", "and",   "or",   "not", "const"};
    return std::ranges::find(keywords, word) != keywords.end();
}

// Whether the name could be one of ours: a type, or a function of two words that is called.
bool is_name(const Word& word) {
    const bool type = std::isupper(static_cast<unsigned char>(word.text[0])) != 0 &&
                      std::ranges::any_of(word.text, [](unsigned char c) { return std::islower(c) != 0; });
    const bool function = std::islower(static_cast<unsigned char>(word.text[0])) != 0 && word.next == '(' &&
                          word.text.find('_') != std::string::npos;
    return type || function;
}

// The names that a header declares at the beginning of a line: types and functions; `forward`: types that it leaves to
// others to define, too.
std::set<std::string> declared_in(const SourceFile& header, const std::vector<Word>& words, bool forward) {
    std::set<std::string> names;
    for (const Word& word : words) {
        const std::string& line = header.lines[word.line - 1];
        if (line.starts_with(' ') || line.starts_with('}') || word.first) continue;
        const bool function = word.next == '(' && !word.before.empty() && !is_keyword(word.before);
        const bool type = declares_a_type(word.before) && (forward || word.next != ';');
        if (is_name(word) && (type || function)) names.insert(word.text);
    }
    return names;
}

} // namespace

std::vector<std::string> missing_includes(const std::vector<SourceFile>& files, std::string_view folder) {
    std::map<std::string, const SourceFile*> by_path;
    std::map<std::string, std::set<std::string>> declared; // headers that declare a name
    std::set<std::string> defined;                         // in one of them
    std::map<std::string, std::vector<Word>> words;
    std::map<std::string, std::vector<std::string>> included;
    for (const SourceFile& file : files) {
        if (!file.path.starts_with(folder)) continue;
        by_path[file.path] = &file;
        words[file.path] = words_of(file);
        for (const Include& include : includes_of(file))
            if (include.quoted) included[file.path].push_back(include.target);
        if (!file.path.ends_with(".h")) continue;
        for (const std::string& name : declared_in(file, words[file.path], true))
            declared[name].insert(file.path);
        defined.merge(declared_in(file, words[file.path], false));
    }
    // Names that a file declares anywhere, its members and variables too: what a type or "auto" stands before.
    std::map<std::string, std::set<std::string>> own;
    for (const auto& [path, list] : words)
        for (const Word& word : list)
            if (!word.before.empty() && !is_keyword(word.before)) own[path].insert(word.text);
    std::vector<std::string> found;
    for (const auto& [path, file] : by_path) {
        std::set<std::string> reached, known;
        std::vector<std::string> open{path};
        while (!open.empty()) {
            const std::string next = open.back();
            open.pop_back();
            if (!by_path.contains(next) || !reached.insert(next).second) continue;
            known.insert(own[next].begin(), own[next].end());
            open.insert(open.end(), included[next].begin(), included[next].end());
        }
        for (const Word& word : words[path]) {
            const auto headers = declared.find(word.text);
            if (headers == declared.end() || !defined.contains(word.text)) continue;
            if (!is_name(word) || known.contains(word.text)) continue;
            if (word.previous == '.' || word.previous == ':' || word.previous == '>') continue; // a member
            found.push_back(path + ":" + std::to_string(word.line) + ": " + word.text + " needs #include \"" +
                            *headers->second.begin() + "\"");
            known.insert(word.text);
        }
    }
    return found;
}

} // namespace montelux::house
