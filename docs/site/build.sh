#!/bin/sh
# Builds the site of the documentation at build/site, from the root of the repository; needs a network the first time.
# Usage: build.sh PROGRAM [FOLDER-OF-THE-PYTHON-PACKAGE]
set -eu
program=$1
package=${2:-}
environment=build/docs-environment
parts=build/docs # what the pages are made of, beside docs/
fail() {
    echo "make docs: $1" >&2
    exit 1
}

command -v doxygen >/dev/null 2>&1 || fail "there is no doxygen (Debian: doxygen)"
requirements=docs/site/requirements.txt
if ! cmp -s $requirements $environment/requirements.txt; then
    python=/usr/bin/python3
    [ -x $python ] || python=python3
    rm -rf $environment
    $python -m venv $environment || fail "python3 -m venv does not work (Debian: python3-venv)"
    $environment/bin/python -m pip install --quiet --disable-pip-version-check --only-binary :all: -r $requirements ||
        fail "pip could not install what $requirements names"
    cp $requirements $environment/requirements.txt
fi

rm -rf $parts
mkdir -p $parts/generated $parts/python
python3 docs/site/command_line.py "$program" >$parts/generated/command-line.md
doxygen docs/site/Doxyfile >$parts/doxygen.log 2>&1 || fail "doxygen failed: $parts/doxygen.log"
python3 docs/site/cpp_page.py $parts/cpp.tag >$parts/generated/cpp.md
cp -r python/montelux $parts/python/
if [ -n "$package" ] && [ -e "$package/_core.pyi" ]; then
    cp "$package/_core.pyi" $parts/python/montelux/
    cp docs/site/python_page.txt $parts/generated/python.md
else
    echo "make docs: the Python module was not built, so the page of its classes is empty." >&2
    printf '# The Python package\n\nThe Python module was not built with this site. [Guide](../python.md).\n' >$parts/generated/python.md
fi
NO_MKDOCS_2_WARNING=1 $environment/bin/mkdocs build --quiet --strict
echo "build/site/index.html"
