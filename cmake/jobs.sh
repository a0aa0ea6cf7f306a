#!/bin/sh
# Number of compilers to run at once: one per core, but at most one per 1.5 GB of free memory.
cores=$(nproc 2>/dev/null || echo 1)
memory=$(awk '/^MemAvailable:/ {print int($2 / 1500000)}' /proc/meminfo 2>/dev/null)
[ "${memory:-0}" -ge 1 ] || memory=1
[ "$memory" -lt "$cores" ] && echo "$memory" || echo "$cores"
