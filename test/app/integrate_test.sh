#!/bin/sh
# montelux integrate: results, files, limits, messages for mistakes.
. "$(dirname "$0")/common.sh"

# field NAME: a number of the JSON in the file `json`, in one line.
field() { tr -d ' \n' <json | grep -o "\"$1\":[^,}]*" | head -n 1 | cut -d: -f2; }
# close VALUE EXACT TOLERANCE
close() { awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN { d = a - b; if (d < 0) d = -d; exit !(d <= t) }'; }
# value EXACT TOLERANCE arguments...: the first value of a run.
value() {
    exact=$1 tolerance=$2
    shift 2
    "$montelux" integrate "$@" --json --quiet >json 2>err || fail "montelux integrate $*: exit code $?: $(cat err)"
    close "$(tr -d ' \n' <json | sed 's/.*"value":\[*\([^],]*\).*/\1/')" "$exact" "$tolerance" ||
        fail "montelux integrate $*: $(head -n 8 json) instead of $exact"
}

# The command of the README.
expect 0 "error target reached" integrate 'sin(x)*y' --over x=0:pi/2 --over y=0:1 --relative-error 1e-2
value 0.5 0.02 'sin(x)*y' --over x=0:pi/2 --over y=0:1 --relative-error 5e-3
# Ranges: infinite ones, formulas at their ends, several variables at once.
value 1 0.02 'exp(-x)' --over x=0:inf --method basic --evaluations 1e5
value 1.7724539 0.05 'exp(-x^2)' --over x=-inf:inf --method basic --evaluations 1e5
value 8 1e-9 1 --over 'x,y=-1:1' --over 'z=0:sqrt(4)'
value 32 1e-9 1 --over x1..x5=0:2
value 2 0.01 'x<1 ? 2 : 2' --over x=0:1
value 1 0.02 '(x^2 - 2*x + 1)*3' --over x=0:1
value 0.842700793 0.01 'erf(1) + 0*x' --over x=0:1
value 2 0.01 'e' --over e=0:2 # a variable may be called like a constant
# Peaks at the formula's own numbers: beside each variable, as a root, as a constant.
value 6.5973446 0.03 'exp(-(x^2+y^2)/2)+1e5*exp(-1e6*((x-0.37)^2+(0.61+y)^2))' --over x,y=-5:5 --relative-error 1e-3
value 1.4322889 0.003 'cos(x)+1e4*exp(-((3*x-1)*1e4)^2)' --over x=0:1 --relative-error 1e-3
value 1.0886227 0.003 '1+500*exp(-((x-sqrt(0.37))/1e-4)^2)' --over x=0:1 --relative-error 1e-3
value 12.566371 0.03 'exp(-((x-3)^2+y^2)/2)+1e4*exp(-5000*((x+4)^2+(y-2)^2))' --over x,y=-10:10 --relative-error 1e-3
value 9.424778 0.03 'exp(-(x^2+y^2)/2)+1e4*exp(-((x+y-4)^2+(x-y+2.5)^2)/2e-4)' --over x,y=-10:10 --relative-error 1e-3
value 9.93449 0.03 'max(0,z)+(0.6*x+0.8*z>cos(0.00465) ? 1e5 : 0)' --over x,y,z --domain sphere --relative-error 1e-3
# A warning takes back the claim, and says so.
expect 3 "error target reached, but with a warning" integrate 'sqrt(x)' --over x=-1:1 --relative-error 1e-2
# A leading minus sign begins a formula, not an option; option values and what follows '--' are left alone.
value -0.33333333 1e-6 -x^2 --over x=0:1
value -0.5 1e-6 '-(x)' --over x=0:1
value -1 1e-6 --over x=0:1 -2*x
expect 0 '-0.5000' integrate --over x=0:1 -- -x
"$montelux" integrate -x x^2 -.5*x --over=x=0:1 --evaluations 1e4 >out 2>&1
[ "$(cut -d: -f1 out | head -n 3 | tr '\n' ' ')" = "-x x^2 -.5*x " ] || fail "formulas with a minus sign: $(cat out)"
# Counts with units.
for count in 3000=3k 3000=3e3 2500=2.5k 100000=.1M 1000000=1M 2000000=0.002G; do
    "$montelux" integrate x --over x=0:1 --method basic --evaluations "${count#*=}" >out 2>&1
    grep -q "^${count%=*} evaluations" out || fail "--evaluations ${count#*=}: $(cat out)"
done
# Without a target, auto keeps the samples that it has.
value 1 1e-6 'exp(-x)' --over x=0:inf --evaluations 1e5
value 0.25 1e-6 'x*y' --over x,y=0:1 --evaluations 1e5
# A pole in the middle, where its sides cancel, is no convergence; a single value that is missing costs nothing.
for method in auto cubature; do
    expect 3 "diverges, or converges too slowly" integrate 1/x --over x=-1:1 --absolute-error 1e-6 \
        --method $method --evaluations 1e5
    expect 3 "diverges, or converges too slowly" integrate 'x/(x*x+y*y)^2' --over x,y=-1:1 --absolute-error 1e-3 --method $method \
        --evaluations 1e5
    expect 0 "error target reached" integrate 'sin(x)/x' --over x=-1:1 --absolute-error 1e-9 --method $method
done
expect 3 "diverges, or converges too slowly" integrate 1/x --over x=-1:1 --absolute-error 1e-6
expect 3 "diverges, or converges too slowly" integrate '1/(x-0.5)' --over x=0:1 --relative-error 1e-3
value 1.892166140734366 1e-9 'sin(x)/x' --over x=-1:1 --absolute-error 1e-9
value 4 1e-5 '1/sqrt(abs(x))' --over x=-1:1 --absolute-error 1e-6
# Values that are left out are told, and no target counts as reached.
expect 3 "were not finite and were left out" integrate 'sqrt(1-x^2-y^2)' --over x,y=-1:1 --absolute-error 3e-5
# Densities: the integrand over its own density has no error.
value 0.2 1e-9 'exp(-5*x)' --over x=0:inf --density 'x=exp(-5*x)' --method basic --evaluations 5000
value 0.2 0.002 'exp(-5*x)*2*y' --over x=0:inf --over y=0:1 --density x='3*exp(-5*x)' --evaluations 1e5
value 2 0.02 '1/sqrt(x)' --over x=0:1 --density '1/sqrt(x)' --evaluations 5000
# Domains
value 3.14159265 1e-6 1 --domain ball --over x,y
value 0.16666667 1e-6 1 --domain simplex --over x,y,z
value 50.2654825 1e-5 1 --domain sphere --radius 2 --centre 1,2,pi --over x,y,z
# Every method by its name does a smooth integral in one variable, or says why not.
for method in $("$montelux" integrate --help | sed -n 's/.*How: //p;/How: /,/Default/p' | tr -d ',.\n' |
    sed 's/.*How: //; s/Default.*//'); do
    timeout 60 "$montelux" integrate 'sin(x)' --over x=0:pi/2 --method "$method" --evaluations 20000 --quiet --json >json 2>err
    code=$?
    if [ $code -eq 0 ]; then
        close "$(field value)" 1 0.05 || fail "--method $method: $(head -n 3 json)"
    elif ! grep -q "montelux: error: " err; then
        fail "--method $method: exit code $code: $(cat err)"
    fi
done

# JSON is JSON, for scalars, vectors and numbers that it does not know.
"$montelux" integrate x x^2 --over x=0:1 --method basic --evaluations 5000 --json >vector.json
"$montelux" integrate x --over x=0:1 --method basic --evaluations 1 --json >one.json # an infinite error
"$montelux" integrate 'x<0.5 ? 1 : nan' --over x=0:1 --method basic --evaluations 5000 --json >nan.json
if command -v python3 >/dev/null; then
    python3 - <<'END' || fail "the JSON is not as documented"
import json
def read(name):
    def refuse(text): raise ValueError(text)
    return json.load(open(name), parse_constant=refuse)
v, one, nan = read("vector.json"), read("one.json"), read("nan.json")
keys = "value standard_error covariance evaluations method reason chi_squared degrees_of_freedom chi_squared_per_degree p_value converged stop warnings non_finite history"
assert all(k in v for k in keys.split()) and not any("chi2" in k for k in v)
assert len(v["value"]) == 2 and len(v["standard_error"]) == 2
assert len(v["covariance"]) == 2 and len(v["covariance"][0]) == 2
assert v["covariance"][0][1] == v["covariance"][1][0]
assert v["stop"] == "evaluations" and v["converged"] is False and v["evaluations"] == 5000
assert v["history"][-1]["evaluations"] == 5000
assert isinstance(one["value"], float) and one["standard_error"] is None and one["covariance"] is None
assert 0.4 < nan["value"] < 0.6 and nan["non_finite"] > 2000 and len(nan["warnings"]) == 1
assert nan["first_non_finite_point"][0] > 0.5
END
fi

# The seed decides, the number of threads does not.
for threads in 1 2 5; do
    "$montelux" integrate 'sin(x*y)' --over x,y=0:1 --evaluations 1e5 --threads $threads --json |
        grep -v seconds >threads$threads
done
cmp -s threads1 threads2 && cmp -s threads1 threads5 || fail "the number of threads changes the result"
"$montelux" integrate 'sin(x*y)' --over x,y=0:1 --evaluations 1e5 --seed 1 --json | grep -v seconds >seed
cmp -s threads1 seed && fail "the seed changes nothing"

# Logarithms of integrals that no double holds.
log_value() {
    exact=$1
    shift
    "$montelux" integrate --log "$@" --json --quiet >json 2>err || fail "montelux integrate --log $*: exit code $?: $(cat err)"
    close "$(field log_value)" "$exact" "$(awk -v e="$(field log_error)" 'BEGIN { print 5 * e + 1e-11 }')" ||
        fail "montelux integrate --log $*: $(head -n 4 json) instead of $exact"
    [ "$(field converged)" = true ] || fail "montelux integrate --log $*: not converged"
}
log_value -4999.081061466796 -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6
log_value 5000.918938533204 '5000-x^2/2' --over x=-inf:inf --relative-error 1e-3 --method vegas
log_value -1998.162122933590 '-2000-(x^2+y^2)/2' --over x,y=-inf:inf --relative-error 1e-3 --method adaptive
log_value -2001.609437912434 'x<0 ? -inf : -2000-5*x' --over x=-1:9 --relative-error 1e-3 --method quasi
log_value -8001.609437912434 '-8000-5*x' --over x=0:inf --density 'x=exp(-5*x)' --method basic --relative-error 1e-3
log_value -898.567588041694 '-900' --domain ball --over x,y,z --relative-error 1e-6
grep -q '^  "value"' json && fail "a relative value is printed as Z: $(cat json)"
expect 0 "log Z = -4999.08106" integrate --log -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6
expect 3 "stopped at the number of evaluations" integrate --log -5000-x^2/2 --over x=-inf:inf --relative-error 1e-6 --method basic --evaluations 10k
expect 0 "log Z = -inf" integrate --log 'log(0*x)' --over x=0:1 --method basic --evaluations 1000
expect 2 "--log: 2 formulas were given; expected one" integrate --log x 1 --over x=0:1
expect 2 "expected --relative-error, which is the error of log Z" integrate --log x --over x=0:1 --absolute-error 1
expect 2 "leave out one of --log and --plot" integrate --log x --over x=0:1 --plot plot.svg
expect 1 "is zero where '-5*x-8000' is not" integrate --log -5*x-8000 --over x=-1:1 --density 'x=x<0 ? 0 : exp(-5*x)'
# A killed run of logarithms resumes to the same digits.
log_run="--log x*y-3000 --over x,y=0:1 --method basic --evaluations 5M --quiet"
"$montelux" integrate $log_run --json | grep -v seconds >uninterrupted
rm -f log log.previous
timeout -s KILL 0.2 "$montelux" integrate $log_run --checkpoint log --checkpoint-every 0 >/dev/null 2>&1
"$montelux" integrate $log_run --checkpoint log --resume --json | grep -v seconds >resumed
cmp -s uninterrupted resumed || fail "log Z of a resumed run: $(head -n 3 resumed) instead of $(head -n 3 uninterrupted)"

# Threads make their parsers at the same time.
formulas=$(seq -f '1.5*x+%g.5' 200)
for run in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20; do
    "$montelux" integrate $formulas --over x=0:1 --method quasi --evaluations 1024 --threads 16 --quiet >out 2>&1 ||
        fail "200 formulas by 16 threads: exit code $?"
done

# Exit codes: 3 where a target was not reached.
expect 3 "stopped at the number of evaluations" integrate x --over x=0:1 --method basic --relative-error 1e-9 --evaluations 1e4
expect 3 "stopped by time" integrate x --over x=0:1 --method basic --relative-error 1e-12 --time 0.3
expect 0 "stopped by time" integrate x --over x=0:1 --method basic --time 0.2

# Files
expect 0 "100000 evaluations" integrate 'x*y' --over x,y=0:1 --method basic --evaluations 1e5 --plot plot.svg --points points.csv --points-limit 100
grep -q '</svg>' plot.svg || fail "the plot is not whole"
for text in 'evaluations N' 'standard error' 'value' '1/√N'; do
    grep -q "$text" plot.svg || fail "the plot does not say '$text'"
done
[ "$(wc -l <points.csv)" -eq 101 ] || fail "$(wc -l <points.csv) lines of points instead of 101"
[ "$(head -n 1 points.csv)" = "x,y,x*y" ] || fail "columns of the points: $(head -n 1 points.csv)"
awk -F, 'NR > 1 { d = $1 * $2 - $3; if (d > 1e-12 || d < -1e-12) exit 1 }' points.csv || fail "the values are not those of the points"
cp points.csv first.csv
expect 0 "100000 evaluations" integrate 'x*y' --over x,y=0:1 --method basic --evaluations 1e5 --points points.csv --points-limit 100
cmp -s points.csv first.csv || fail "the points differ between two equal runs"
if command -v python3 >/dev/null; then
    python3 -c 'import xml.etree.ElementTree as e; e.parse("plot.svg")' || fail "the plot is no XML"
fi

# Checkpoints: a resumed run has the digits of an uninterrupted one, also after a kill at any moment.
"$montelux" integrate 'sin(x)*y' --over x,y=0:1 --method basic --evaluations 3e7 --quiet --json | grep -v seconds >uninterrupted
for wait in 0.05 0.2 0.4; do
    rm -f state state.previous
    "$montelux" integrate 'sin(x)*y' --over x,y=0:1 --method basic --evaluations 3e7 --quiet --checkpoint state \
        --checkpoint-every 0 >/dev/null 2>&1 &
    pid=$!
    sleep $wait
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    "$montelux" integrate 'sin(x)*y' --over x,y=0:1 --method basic --evaluations 3e7 --quiet --checkpoint state --resume \
        --json | grep -v seconds >resumed
    cmp -s uninterrupted resumed || fail "killed after $wait s, the resumed run has other digits"
done
expect 2 "exists already; add --resume" integrate 'sin(x)*y' --over x,y=0:1 --checkpoint state
# The previous generation by itself is a checkpoint.
cp state alone.previous
expect 2 "exists already; add --resume" integrate 'sin(x)*y' --over x,y=0:1 --checkpoint alone
cmp -s state alone.previous || fail "a refused run replaced the previous generation"
expect 0 "" integrate 'sin(x)*y' --over x,y=0:1 --method basic --evaluations 3e7 --checkpoint alone --resume
expect 1 "belongs to another integrand, domain, method or seed" integrate x --over x=0:1 --method basic --checkpoint state --resume
head -c 100 state >cut
expect 1 "is cut short" integrate 'sin(x)*y' --over x,y=0:1 --method basic --checkpoint cut --resume
cp state cut.previous
expect 0 "is cut short" integrate 'sin(x)*y' --over x,y=0:1 --method basic --checkpoint cut --resume
expect 0 "" integrate 'sin(x)*y' --over x,y=0:1 --method basic --checkpoint cut --resume
grep -q warning out && fail "a warning about an undamaged checkpoint: $(cat out)"
echo hello >text
expect 1 "is not a saved state" integrate x --over x=0:1 --checkpoint text --resume

# Ctrl-C prints the result so far.
"$montelux" integrate x --over x=0:1 --method basic --relative-error 1e-12 --quiet --json >json 2>err &
pid=$!
sleep 0.5
kill -INT $pid
wait $pid
code=$?
[ $code -eq 130 ] || fail "INT: exit code $code instead of 130: $(cat err)"
close "$(field value)" 0.5 0.01 || fail "INT: $(head -n 3 json)"
grep -q '"stop": "interrupted"' json || fail "INT: the result does not say so"
if command -v script >/dev/null; then
    script -qec "'$montelux' integrate x --over x=0:1 --method basic --relative-error 1e-9 --time 0.5" /dev/null >out 2>&1 </dev/null
    grep -q 'evaluations, 0\.' out || fail "no progress on a terminal: $(cat out)"
fi

# Mistakes of a new user.
expect 2 "expected a FORMULA, --library or --source" integrate
expect 2 "a box has none" integrate 1 --over x=0:1 --radius 2
expect 2 "a simplex has none" integrate 1 --domain simplex --over x,y --centre 1,1
expect 2 "--checkpoint-every: expected --checkpoint FILE" integrate 1 --over x=0:1 --checkpoint-every 5
expect 2 "the name of a file is expected" integrate 1 --over x=0:1 --checkpoint ''
expect 2 "two outputs have the same name" integrate x --over x=0:1 --checkpoint p.svg --plot p.svg
expect 0 "error target reached" integrate x --over x=0:1 --method basic --relative-error 1%
expect 0 "stopped by time" integrate x --over x=0:1 --method basic --time 0.1s
expect 2 "there is no variable 'a'; a number is expected here" integrate x --over x=a:1
expect 2 "expected a finite number above 0" integrate x --over x=0:1 --relative-error 0%
expect 2 "--time: at character" integrate x --over x=0:1 --time 10x
expect 2 "no variable is given" integrate 'sin(x)'
expect 2 "the range is reversed" integrate x --over x=1:0
expect 2 "the range is empty" integrate x --over x=1:1
expect 2 "the upper end 'nan' is not a number" integrate x --over x=0:nan
expect 2 "the lower end '0/0' is not a number" integrate x --over x=0/0:1
expect 2 "is not a range" integrate x --over x=0
expect 2 "the range has no upper end" integrate x --over x=0:
expect 2 "no range is given" integrate x --over x
expect 2 "is not a name of a variable" integrate x --over 2x=0:1
expect 2 "'sin' is a function" integrate x --over sin=0:1
expect 2 "is given twice" integrate x --over x=0:1 --over x=0:2
expect 2 "there is no variable 'z'" integrate 'x*z' --over x=0:1
expect 2 "at character 3" integrate 'x*z' --over x=0:1
expect 2 "there is no function 'sine' (did you mean 'sin'?)" integrate 'sine(x)' --over x=0:1
expect 2 "the function 'sin' takes its arguments in brackets: sin(x)" integrate 'sin x' --over x=0:1
expect 2 "the function 'pow' takes its arguments in brackets: pow(x, y)" integrate '2*pow' --over x=0:1
expect 2 "there is no variable 'sine' (did you mean 'sin'?)" integrate 'sine x' --over x=0:1
expect 2 "at character 4: the function 'exp' takes" integrate '-2*exp x' --over x=0:1
expect 2 "at character 2: '**' is not expected here; powers are written x^2" integrate 'x**2' --over x=0:1
expect 2 "there is no variable 'o', and no option '-o'" integrate x -o out.txt --over x=0:1
expect 2 "there is no option '--evaluation' (did you mean '--evaluations'?)" integrate x --over x=0:1 --evaluation 10
expect 2 "a closing bracket is missing" integrate 'sin(x' --over x=0:1
expect 2 "the formula ends too early" integrate 'x+' --over x=0:1
expect 2 "the formula is empty" integrate '' --over x=0:1
expect 2 "products need a '*'" integrate '3x' --over x=0:1
expect 2 "'==' compares" integrate 'x=3' --over x=0:1
expect 2 "comparisons are not chained" integrate '0<x<0.5' --over x=-1:1
expect 0 "1.5000" integrate '(0<x)==(x<=0.5) && x!=2 || max(x<0,x>1)>0' --over x=-1:1 --evaluations 1e4
expect 2 "an argument of its own" integrate 'x,x' --over x=0:1
expect 2 "gets too many arguments" integrate 'sin(x,x)' --over x=0:1
expect 2 "there is no variable 'y'" integrate x --over x=0:y
"$montelux" integrate 'x*z' --over x=0:1 2>out
grep -qx '      ^' out || fail "no caret under the mistake: $(cat out)"
expect 2 "there is no method 'basci' (did you mean 'basic'?)" integrate x --over x=0:1 --method basci
expect 2 "there is no domain 'bal' (did you mean 'ball'?)" integrate x --over x --domain bal
expect 2 "at least 2 dimensions" integrate x --over x --domain sphere
expect 2 "only a box has ranges" integrate x --over x=0:1 --domain ball
expect 2 "2 coordinates were given for 3 variables" integrate x --over x,y,z --domain ball --centre 1,2
expect 2 "expected a finite number above 0" integrate x --over x=0:1 --relative-error 0
expect 2 "expected a finite number above 0" integrate x --over x=0:1 --absolute-error -1
expect 2 "expected a finite number above 0 of seconds" integrate x --over x=0:1 --time nan
expect 2 "expected a whole number from 1" integrate x --over x=0:1 --evaluations 0
expect 2 "expected a whole number" integrate x --over x=0:1 --evaluations 1.5
expect 2 "'1.0005k' was given; expected a whole number" integrate x --over x=0:1 --evaluations 1.0005k
expect 2 "--evaluations: at character" integrate x --over x=0:1 --evaluations k
expect 2 "expected a whole number from 0 to 4096" integrate x --over x=0:1 --threads -1
expect 2 "there is no policy 'ignore'" integrate x --over x=0:1 --non-finite ignore
expect 2 "expected --checkpoint FILE" integrate x --over x=0:1 --resume
expect 2 "ends in .svg" integrate x --over x=0:1 --plot plot.png
expect 1 "/no/such/folder/p.svg" integrate x --over x=0:1 --plot /no/such/folder/p.svg
expect 1 "/no/such/folder/p.csv" integrate x --over x=0:1 --points /no/such/folder/p.csv
expect 1 "/no/such/folder/state" integrate x --over x=0:1 --checkpoint /no/such/folder/state
expect 1 "is zero where '1' is not" integrate 1 --over x=0:1 --density 'x<0.5 ? 1 : 0'
expect 1 "--density 'x - 0.5'" integrate 1 --over x=0:1 --density 'x - 0.5'
expect 1 "--density '1/x'" integrate 1 --over x=0:1 --density '1/x'
expect 1 "--density '0*x'" integrate 1 --over x=0:1 --density '0*x'
expect 2 "--density x: at character 1: there is no variable 'y'" integrate 1 --over x=0:1 --over y=0:1 --density x=y
expect 2 "there is no variable 'z'" integrate 1 --over x=0:1 --density 'z=1'
expect 2 "has a density already" integrate 1 --over x=0:1 --density x=1 --density x=2
expect 1 "is a finite number" integrate 'sqrt(-1-x)' --over x=0:1
expect 1 "the integrand is nan at (" integrate 'sqrt(x-0.5)' --over x=0:1 --non-finite throw
expect 0 "were not finite and were left out" integrate 'sqrt(x-0.5)' --over x=0:1 --evaluations 1e4
grep -q '^warning: ' out || fail "no warning: $(cat out)"
grep -q doubt out && fail "the text has another word for a warning: $(cat out)"
value 5000 0.05 'x9999 + x10000 + 4999' --over x1..x10000=0:1 --method basic --evaluations 2000
finish
