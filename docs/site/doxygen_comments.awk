# Headers as Doxygen reads them: the first line describes the file, a block of // lines what follows it at once, a //
# after code what stands before it.
# <name> in a comment is no tag.
{
    text = $0
    comment = match(text, /\/\/ /) && text !~ /`/ ? substr(text, RSTART) : ""
    if (comment != "") {
        text = substr(text, 1, RSTART - 1)
        gsub(/<[a-z]/, "\\\\&", comment)
    }
    line[NR] = text comment
}
FNR == 1 && sub(/^\/\/ /, "", line[1]) { line[1] = "/// \\file\n/// " line[1] }
END {
    print line[1]
    for (n = 2; n <= NR; ++n) {
        text = line[n]
        if (text ~ /^ *\/\/( |$)/) {
            last = n
            while (line[last] ~ /^ *\/\/( |$)/) ++last
            # Of the file: its first lines. Of nothing: what an empty line follows.
            about = n == 2 || line[last] !~ /^ *(#.*|})?$/
            for (; n < last; ++n) {
                if (about) sub(/\/\//, "///", line[n])
                print line[n]
            }
            --n
            continue
        }
        if (text ~ /[;,)}] +\/\/ / && text !~ /"[^"]*\/\//) sub(/\/\/ /, "///< ", text)
        print text
    }
}
