# Runs on a bare Debian: the packages by apt, a picture, the viewer, the manual, the module, a program that links the library.
cd /montelux
apt-get -qq update
before=$(du -sk /usr | cut -f 1)
apt-get -qq install --no-install-recommends ./montelux_*.deb >/dev/null
echo "montelux and what it needs: $((($(du -sk /usr | cut -f 1) - before) / 1024)) MB"
montelux --version
montelux integrate 'sin(x)*y' --over x=0:pi/2 --over y=0:1 --relative-error 1e-4 --quiet
montelux render scenes/demo/studio.pbrt --resolution 160x90 --spp 4 -o picture.png --quiet
test -s picture.png

apt-get -qq install --no-install-recommends ./python3-montelux_*.deb >/dev/null
mkdir /use
cd /use
ln -s /montelux/scenes scenes
python3 -c 'import montelux; print(montelux.__version__, montelux.integrate(lambda x: x * x, (0, 1), relative_error=1e-3))'

montelux view scenes/demo/studio.pbrt --resolution 160x90 --spp 16 2>address.txt &
server=$!
for _ in $(seq 100); do
    url=$(sed -n 's/^The render is shown at //p' address.txt)
    [ -n "$url" ] && break
    sleep 0.1
done
python3 - "$url" <<'END'
import sys
import urllib.request

page = urllib.request.urlopen(sys.argv[1], timeout=20).read().decode()
assert "<title>" in page and "script" in page, page[:200]
print("the page of montelux view:", len(page), "bytes")
END
kill -TERM $server
wait $server || [ $? -eq 130 ] # 130: it was still rendering

apt-get -qq install --no-install-recommends man-db bash-completion >/dev/null
man -P cat montelux-render | grep -q -- --target-error
bash -c '. /usr/share/bash-completion/bash_completion; _completion_loader montelux; complete -p montelux' | grep -q _montelux

apt-get -qq install --no-install-recommends /montelux/libmontelux-dev_*.deb cmake g++ make >/dev/null
for example in consumer renderer; do
    cmake -S /montelux/examples/$example -B /use/$example -D CMAKE_BUILD_TYPE=Release >/dev/null
    cmake --build /use/$example >/dev/null
done
/use/consumer/integral
apt-get -qq purge montelux libmontelux-dev python3-montelux >/dev/null
left=$(find /usr -path '*montelux*' | head)
[ -z "$left" ] || { echo "left after purging: $left" && exit 1; }
