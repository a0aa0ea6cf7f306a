# From a page of the documentation to a test: its ```cpp blocks, each a whole file, one after another. What they include
# of one another is dropped: lines that match `own`. Compilers' messages name the lines of the page.
/^```cpp$/ {
    inside = 1
    ++blocks
    printf "#line %d \"%s\"\n", FNR + 1, FILENAME
    next
}
/^```/ { inside = 0 }
!inside || /^#pragma once$/ { next }
own != "" && $0 ~ "^#include \".*" own { print ""; next }
{ print }
END {
    if (!blocks) exit 1
    if (last != "") printf "#include \"%s\"\n", last
}
