"""A scene of a ball, a lamp and a sky, for tests; and the temporary files of textures."""

TEXT = """
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
Sampler "zsobol" "integer pixelsamples" 16 "integer seed" 3
LookAt 0 -4 0  0 0 0  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 2 2 2 ]
  Translate 0 0 3
  Shape "trianglemesh" "point3 P" [ -1 -1 0  1 -1 0  1 1 0  -1 1 0 ] "integer indices" [ 0 1 2  0 2 3 ]
AttributeEnd
Shape "sphere"
"""


def unnamed_files():
    """How many parts of files without a name this process has mapped."""
    with open("/proc/self/maps") as maps:
        return sum("(deleted)" in line for line in maps)
