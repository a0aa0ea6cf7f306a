#!/bin/sh
# Mitsuba scenes from the command line: parameters, includes, messages.
. "$(dirname "$0")/common.sh"

cat >scene.xml <<'XML'
<?xml version="1.0" encoding="utf-8"?>
<!-- A grey ball under a white sky. -->
<scene version="3.0.0">
    <default name="spp" value="2"/>
    <default name="grey" value="0.5"/>
    <integrator type="path"><integer name="max_depth" value="3"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 1 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="16"/></film>
        <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
    </sensor>
    <emitter type="constant"/>
    <include filename="parts/ball.xml"/>
</scene>
XML
mkdir -p parts
cat >parts/ball.xml <<'XML'
<scene version="3.0.0">
    <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="$grey"/></bsdf></shape>
</scene>
XML

expect 0 "" render scene.xml -o grey.pfm
expect 0 "24 x 16" info grey.pfm
expect 0 "" render scene.xml -o same.pfm -D grey=0.5 -D spp=2
cmp -s grey.pfm same.pfm || fail "-D with the default values changes the picture"
expect 0 "" render scene.xml -D grey=0.25 -o dark.pfm
cmp -s grey.pfm dark.pfm && fail "-D has no effect"
expect 0 "" render -D spp=1 scene.xml -o fewer.pfm
cmp -s grey.pfm fewer.pfm && fail "-D spp has no effect"
expect 0 "shapes       1 sphere" info scene.xml -D spp=4
expect 0 "the scene does not use the parameter 'gray'" render scene.xml -D gray=1 -o other.pfm
expect 2 "NAME=VALUE" render scene.xml -D grey -o other.pfm
expect 2 "NAME=VALUE" render scene.xml -D =1 -o other.pfm
scene old "$sky Shape \"sphere\""
expect 1 "old.pbrt: only Mitsuba scenes have parameters that can be defined" render old.pbrt -D grey=1 -o other.pfm

expect 0 "roughplastic" formats mitsuba
expect 0 '"plugin": "roughplastic"' formats mitsuba --json
sed 's/type="sphere"/type="spere"/' parts/ball.xml >parts/misspelt.xml
sed 's/ball.xml/misspelt.xml/' scene.xml >misspelt.xml
expect 1 "parts/misspelt.xml:2:5: there is no shape 'spere' (did you mean 'sphere'?)" render misspelt.xml -o none.pfm
sed 's/type="independent"/type="idependent"/; s/<integrator type="path">/<integrator type="stokes">/' scene.xml >polarized.xml
expect 1 "polarization" render polarized.xml -o none.pfm
sed 's/<\/scene>//' scene.xml >cut.xml
expect 1 "cut.xml:" render cut.xml -o none.pfm
test ! -e none.pfm || fail "a picture of a broken scene"
finish
