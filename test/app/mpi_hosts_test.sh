#!/bin/sh
# A job over three hosts, which are network namespaces with names and addresses of their own: the bits of one process, and a
# host that vanishes costs no more than the time since the last checkpoint.
. "$(dirname "$0")/common.sh"
command -v mpirun >/dev/null || { echo "skipped: there is no mpirun" && exit 77; }
"$montelux" --version | grep -q "MPI (" || { echo "skipped: built without MPI" && exit 77; }
mpirun --version | grep -q "Open MPI" || { echo "skipped: mpirun is not that of Open MPI" && exit 77; }
job_name=mtx$$
make_hosts() {
    ip link add "$job_name" type bridge && ip link set "$job_name" up || return 1
    for k in 1 2 3; do
        ip netns add "$job_name-$k" && ip link add "$job_name$k" type veth peer name eth0 netns "$job_name-$k" &&
            ip link set "$job_name$k" master "$job_name" up && on_host $k ip addr add 10.91.7.$k/24 dev eth0 &&
            on_host $k ip link set eth0 up && on_host $k ip link set lo up || return 1
    done
    on_host 1 unshare --uts true
}
on_host() {
    k=$1
    shift
    ip netns exec "$job_name-$k" "$@"
}
kill_host() { ip netns pids "$job_name-$1" | xargs -r kill -KILL; }
remove_hosts() {
    for k in 1 2 3; do
        kill_host $k 2>/dev/null
        ip netns del "$job_name-$k" 2>/dev/null
    done
    ip link del "$job_name" 2>/dev/null
    rm -rf "$folder"
}
trap remove_hosts EXIT
make_hosts >out 2>&1 || { echo "skipped: network namespaces cannot be made here (it takes root): $(tail -n 1 out)" && exit 77; }

# mpirun starts its daemons by `agent HOST COMMAND...` in place of ssh.
cat >agent <<END
#!/bin/sh
k=\${1##*.}
shift
exec ip netns exec $job_name-\$k unshare --uts sh -c "hostname $job_name-\$k; \$*"
END
chmod +x agent
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# hosts LIST N command...: one process on each of those hosts; their output is in `out`. Runs until all have ended.
hosts() {
    list=$1 n=$2
    shift 2
    on_host 1 unshare --uts sh -c "hostname $job_name-1; exec \"\$@\"" - timeout -k 1 60 mpirun \
        --mca plm_rsh_agent "$PWD/agent" --mca oob_tcp_if_include 10.91.7.0/24 --mca btl tcp,self \
        --mca btl_tcp_if_include 10.91.7.0/24 --host "$list" --bind-to none -n "$n" "$@" >out 2>&1 </dev/null
    code=$?
}
all=10.91.7.1,10.91.7.2,10.91.7.3
hosts $all 3 hostname
[ $code -eq 0 ] || { echo "skipped: mpirun cannot use network namespaces here: $(tail -n 1 out)" && exit 77; }
[ "$(sort -u out | wc -l)" -eq 3 ] || fail "the job does not have three hosts: $(cat out)"
same() {
    [ "$(wc -c <"$2")" = "$(wc -c <"$3")" ] && [ "$(cmp -l "$2" "$3" | wc -l)" -le 4 ] ||
        fail "$1: the pictures differ in $(cmp -l "$2" "$3" | wc -l) bytes"
}

light='AttributeBegin Translate 0 3 1 AreaLightSource "diffuse" "rgb L" [9 9 9] Shape "sphere" "float radius" 0.3 AttributeEnd'
scene ball "$sky $light Material \"diffuse\" Shape \"sphere\" Translate 1 0 0 Material \"conductor\" Shape \"sphere\"" 70 50
render="$montelux render ball.pbrt --threads 1 -o many.exr --checkpoint state --checkpoint-every 0.05 --resume"

# killed: the host's processes end. unplugged: nothing is heard of it any more, and it works on.
for how in killed unplugged; do
    options='--spp 2000 --adaptive on'
    [ $how = killed ] || options='--spp 256 --integrator bidirectional'
    "$montelux" render ball.pbrt $options --quiet -o one.exr 2>messages || fail "one process: $(cat messages)"
    # A render that ends before its host vanishes is repeated; once, so is one that MPI itself keeps waiting.
    waited=0
    for try in 1 2 3 4 5; do
        rm -f state* many.exr
        hosts $all 3 $render $options --rank-timeout 2 &
        job=$!
        tries=0
        while [ ! -e state ] && [ $tries -lt 400 ]; do sleep 0.05 && tries=$((tries + 1)); done
        begin=$(date +%s)
        if [ $how = killed ]; then
            kill_host 3
        else
            on_host 3 ip link set eth0 down
            # mpirun itself may wait for that host for long; the picture is written before the message.
            while ! grep -q "error: rank 2 has not answered for" out && kill -0 $job 2>/dev/null &&
                [ $(($(date +%s) - begin)) -lt 30 ]; do sleep 0.1; done
            for k in 1 2 3; do kill_host $k; done
        fi
        wait $job
        [ $(($(date +%s) - begin)) -lt 40 ] || fail "$how: the job took $(($(date +%s) - begin)) s to end"
        if [ $how = unplugged ] && ! grep -q "error: rank 2 has not answered for" out && [ ! -e many.exr ]; then
            [ $waited -eq 0 ] || fail "$how: no message: $(cat out)"
            waited=1
        else
            [ -e many.exr ] && ! "$montelux" info many.exr | grep -q '"interrupted" = 1' || break
        fi
        [ $try -lt 5 ] || fail "$how: the render had ended before: $(cat out)"
        on_host 3 ip link set eth0 up
    done
    [ -e state ] || fail "$how: there is no checkpoint: $(cat out)"
    [ $how = killed ] || grep -q "error: rank 2 has not answered for" out || fail "$how: no message: $(cat out)"
    kill_host 3
    hosts 10.91.7.1,10.91.7.2 2 $render $options
    [ $code -eq 0 ] || fail "$how, and resumed on two hosts: exit code $code: $(cat out)"
    same "$how, and resumed on two hosts" one.exr many.exr
done
finish
