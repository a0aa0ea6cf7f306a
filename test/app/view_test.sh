#!/bin/bash
# montelux view and render --view: the same picture, seen and steered by pages; hostile ones change nothing.
client=$(cd "$(dirname "$0")" && pwd)/view_client.py
. "$(dirname "$0")/common.sh"
if ! command -v python3 >/dev/null; then
    echo "skipped: there is no python3"
    exit 77
fi
world='LightSource "infinite" "rgb L" [0.2 0.3 0.4] LightSource "point" "rgb I" [9 9 9] "point3 from" [0 0.9 1.2]
Material "diffuse" Shape "sphere" "float radius" 0.7'
scene lit "$world" 70 50 96
scene long "$world" 200 150 100000

# serve arguments...: starts the program; its page's address is in $url, its process in $!.
serve() {
    rm -f view.out view.err # the address of the server before must not be taken for this one's
    "$montelux" "$@" >view.out 2>view.err </dev/null &
    server=$!
    for _ in $(seq 200); do
        url=$(sed -n 's/^The render is shown at //p' view.err 2>/dev/null)
        [ -n "$url" ] && return
        sleep 0.05
    done
    fail "montelux $*: no address: $(cat view.err)"
}
# ends CODE: the program ends by itself, or does so when it is asked by Ctrl-C.
ends() {
    wait $server
    got=$?
    [ $got -eq "$1" ] || fail "exit code $got instead of $1: $(cat view.out view.err)"
}
watch() {
    timeout 120 python3 "$client" "$url" "$@" >client.out 2>&1 || fail "$*: $(cat client.out view.err)"
}

# same FILE PLAIN: all layers have the same bits.
same() {
    for layer in mean error skewness albedo normal depth samples replicates outlier warning; do
        for picture in "$1" "$2"; do
            "$montelux" convert "$picture" "$picture.pfm" --layer $layer >out 2>&1 || fail "layer '$layer': $(cat out)"
        done
        cmp -s "$1.pfm" "$2.pfm" || fail "$1: layer '$layer' is not that of $2"
    done
}

# Watched, stopped by Ctrl-C after its end, saved by the page and by the program: the bits of an unwatched render.
"$montelux" render lit.pbrt --quiet -o plain.exr
serve view lit.pbrt -o watched.exr
watch final page.exr
kill -INT $server
ends 0
for file in watched.exr page.exr; do
    same $file plain.exr
done
case $url in
http://127.0.0.1:*/\?token=????????????????????????????????) ;;
*) fail "an address of another form: $url" ;;
esac

serve render lit.pbrt --spp 30000 --view -o controls.exr
watch controls
ends 0
grep -q 'target reached' view.out || fail "the target of the page was not said: $(cat view.out)"

serve view lit.pbrt
watch orbit
watch lights
kill -TERM $server
ends 0

# Attacks: the memory stays, a page is answered, and the render ends in time.
serve render long.pbrt --time 30 --view -o attacked.exr
sleep 1
before=$(awk '/VmRSS/ { print $2 }' /proc/$server/status)
watch hostile
after=$(awk '/VmRSS/ { print $2 }' /proc/$server/status)
[ $((after - before)) -lt 60000 ] || fail "attacks took $((after - before)) kB of memory"
ends 0
grep -q '30\.[0-9]* s' view.out || fail "--time 30 became: $(cat view.out)"

# They change no bit of the picture.
"$montelux" render lit.pbrt --spp 1500 --quiet -o unseen.exr
serve view lit.pbrt --spp 1500 -o attacked.exr
watch hostile 1000
watch final page.exr # waits for the end
kill -INT $server
ends 0
same attacked.exr unseen.exr

# tev: all pixels arrive, closed and created first.
port=$((20000 + $$ % 12000))
timeout 60 python3 "$client" tev $port >tev.out 2>&1 &
tev=$!
for _ in $(seq 100); do grep -q listening tev.out && break || sleep 0.05; done
"$montelux" render lit.pbrt --tev 127.0.0.1:$port --quiet -o tev.exr || fail "render --tev"
wait $tev || fail "tev: $(cat tev.out)"
grep -q "^\[2, 4\] (70, 50, 'R,G,B,error.Y') 14000 finite=True" tev.out || fail "tev got: $(cat tev.out)"
same tev.exr plain.exr

# Mistakes.
expect 1 'nothing listens on 127.0.0.1:1' render lit.pbrt --tev 127.0.0.1:1 -o x.exr
expect 1 "'nowhere' is not HOST:PORT" render lit.pbrt --tev nowhere -o x.exr
expect 1 "'localhost' is not an IP address" view lit.pbrt --host localhost
expect 2 'it is the port of the page that --view serves' render lit.pbrt --port 8080 -o x.exr
expect 2 '--port' view lit.pbrt --port 65536
expect 2 'it shows one picture, not a sequence' render lit.pbrt --view --turntable 3 -o x.exr
expect 2 'has 70 x 50 pixels' view long.pbrt --reference plain.exr
expect 2 "there is no option '--frames'" view lit.pbrt --frames 1-3
expect 1 'no.exr' view lit.pbrt --reference no.exr
finish
