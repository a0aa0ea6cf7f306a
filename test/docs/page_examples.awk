# From a page of the documentation to a test: each ```cpp block becomes a scope within that of the block before,
# so that it may use or hide the names of that. What a block prints is compared with a ```text block that follows
# at once. Compilers' messages name the lines of the page.
/^```/ && state != "" {
    follows = state == "cpp"
    state = ""
    next
}
/^```cpp$/ {
    state = "cpp"
    ++blocks
    line[blocks] = FNR
    next
}
/^```text$/ && follows {
    state = "text"
    expected[blocks] = 1
    next
}
/^```/ { state = "other" }
state == "cpp" && /^ *#include/ {
    includes = includes $0 "\n"
    $0 = ""
}
state == "cpp" { code[blocks] = code[blocks] $0 "\n" }
state == "text" { text[blocks] = text[blocks] $0 "\n" }
state == "" { follows = 0 }
END {
    printf "%s", includes
    print "#include \"test/docs/page_test.h\""
    print "PAGE_TEST {"
    for (b = 1; b <= blocks; ++b) {
        printf "{\nPrinted printed%d(%d);\n#line %d \"%s\"\n%s", b, line[b], line[b] + 1, FILENAME, code[b]
        if (expected[b]) printf "printed%d.expect(R\"(%s)\");\n", b, text[b]
        printf "printed%d.end();\n", b
    }
    for (b = 1; b <= blocks; ++b) print "}"
    print "}"
    if (!blocks) exit 1
}
