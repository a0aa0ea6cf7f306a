#!/bin/sh
# How many compilers to run at once: one a core, but no more than one for each 1.5 GB of memory that is free.
cores=$(nproc 2>/dev/null || echo 1)
memory=$(awk '/^MemAvailable:/ {print int($2 / 1500000)}' /proc/meminfo 2>/dev/null)
[ "${memory:-0}" -ge 1 ] || memory=1
[ "$memory" -lt "$cores" ] && echo "$memory" || echo "$cores"
