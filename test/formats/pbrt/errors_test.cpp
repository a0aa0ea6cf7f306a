// Error messages of broken scenes: the place and the sentence.
#include "test/formats/pbrt/parse.h"
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace montelux {
namespace {

using test::error_of;
using test::parse_world;
using test::world_error;

struct Case {
    const char* text; // behind a line "WorldBegin"
    const char* error;
};

TEST(PbrtErrors, SentencesInTheWorld) {
    const Case cases[] = {
        // Tokens.
        {"Shape \"sphere", "scene:2:7: this string has no closing quote on its line"},
        {"Shape \"sph\nere\"", "scene:2:7: this string has no closing quote on its line"},
        {"  Shape \"a\\q\"",
         "scene:2:9: unknown escape '\\q' in a string; expected one of \\b \\f \\n \\r \\t "
         "\\\\ \\' \\\""},
        {"[", "scene:2:1: expected a directive, read '['"},
        {"\n\n \"x\"", "scene:4:2: expected a directive, read the string \"x\""},
        {"Shap \"sphere\"", "scene:2:1: unknown directive 'Shap' (did you mean 'Shape'?)"},
        {"Quux", "scene:2:1: unknown directive 'Quux'"},
        // Parameters.
        {"Shape \"sphere\" \"float\"",
         "scene:2:16: expected a parameter as \"type name\", read the string \"float\""},
        {"Shape \"sphere\" \"float a b\" 1",
         "scene:2:16: expected a parameter as \"type name\", read the string \"float a b\""},
        {"Shape \"sphere\" \"flaot radius\" 1",
         "scene:2:16: unknown parameter type 'flaot' (did you mean 'float'?)"},
        {"Shape \"sphere\" \"color L\" 1", "scene:2:16: parameter type 'color' is not of pbrt-v4; expected "
                                           "'rgb': the file is for pbrt-v3; 'pbrt "
                                           "--upgrade old.pbrt > new.pbrt' of pbrt-v4 converts it"},
        {"Material \"matte\"",
         "scene:2:1: unknown material 'matte': the file is for pbrt-v3; 'pbrt --upgrade "
         "old.pbrt > new.pbrt' of pbrt-v4 converts it"},
        {"Shape \"sphere\" \"float radius\"",
         "scene:2:30: parameter 'radius': expected a value, read the end of "
         "the file"},
        {"Shape \"sphere\" \"float radius\" [ 1", "scene:2:31: the '[' of parameter 'radius' has no ']'"},
        {"Shape \"sphere\" \"float radius\" [ [", "scene:2:33: '[' inside the values of parameter 'radius'"},
        {"Shape \"sphere\" \"float radius\" [ x ]", "scene:2:33: expected a number, read 'x'"},
        {"Shape \"sphere\" \"float radius\" x",
         "scene:2:31: parameter 'radius': expected a number, read 'x'"},
        {"Shape \"sphere\" \"float radius\" \"1\"",
         "scene:2:31: parameter 'radius': expected a number, read the string \"1\""},
        {"Shape \"sphere\" \"float radius\" [ 1e60 ]",
         "scene:2:33: '1e60' is too large for a floating-point number"},
        {"Shape \"sphere\" \"float radius\" nan",
         "scene:2:31: parameter 'radius': expected a number, read 'nan'"},
        {"Shape \"sphere\" \"float radius\" [ 1 2 ]",
         "scene:2:16: parameter 'radius' has 2 values; expected 1"},
        {"Shape \"sphere\" \"float radius\" [ ]", "scene:2:16: parameter 'radius' has 0 values; expected 1"},
        {"Shape \"sphere\" \"integer radius\" 1",
         "scene:2:16: parameter 'radius' has type integer; expected float"},
        {"Shape \"sphere\" \"float radius\" -1", "scene:2:16: parameter 'radius' must be positive"},
        {"Shape \"loopsubdiv\" \"integer levels\" 1.5",
         "scene:2:37: parameter 'levels': expected an integer, read '1.5'"},
        {"Shape \"loopsubdiv\" \"integer levels\" [ 1.5 ]", "scene:2:39: expected an integer, read '1.5'"},
        {"Shape \"loopsubdiv\" \"integer levels\" 3000000000",
         "scene:2:37: '3000000000' is too large for a 32-bit integer"},
        {"AreaLightSource \"diffuse\" \"bool twosided\" yes",
         "scene:2:43: parameter 'twosided': expected true or false, read 'yes'"},
        {"Material \"diffuse\" \"texture reflectance\" 3",
         "scene:2:42: parameter 'reflectance': expected a quoted string, read '3'"},
        // Shapes.
        {"Shape \"spere\"", "scene:2:1: unknown shape 'spere' (did you mean 'sphere'?)"},
        {"Shape \"bilinearmesh\"", "scene:2:1: shape 'bilinearmesh' needs vertex positions 'P'"},
        {"Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "scene:2:1: shape 'bilinearmesh' needs 'indices' when it has not exactly 4 vertices"},
        {"Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 4]",
         "scene:2:59: patch 0 refers to vertex 4; the mesh has 4 vertices"},
        {"Shape \"curve\"", "scene:2:1: shape 'curve' needs control points 'P'"},
        {"Shape \"curve\" \"integer degree\" 4", "scene:2:15: parameter 'degree' must be 2 or 3"},
        {"Shape \"curve\" \"point3 P\" [0 0 0 1 1 1 2 2 2]",
         "scene:2:1: 3 control points were given; expected 4 + n * 3"},
        {"Shape \"curve\" \"float width1\" -1 \"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3]",
         "scene:2:1: the width of a curve is negative"},
        {"Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [0 0 0 1 1 1 2 2 2 3 3 3]",
         "scene:2:1: 0 normals were given for 1 segment; expected 2"},
        {"Shape \"curve\" \"string type\" \"ribbon\" \"normal N\" [0 0 0 0 0 1] \"point3 P\" [0 0 0 1 1 1 2 "
         "2 2 3 3 3]",
         "scene:2:1: a normal is zero"},
        {"Shape sphere", "scene:2:7: Shape: expected a quoted string, read 'sphere'"},
        {"Shape \"trianglemesh\"", "scene:2:1: shape 'trianglemesh' needs vertex positions 'P'"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1]",
         "scene:2:22: parameter 'P' has 8 numbers; expected a multiple of 3"},
        {"Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0]",
         "scene:2:1: shape 'trianglemesh' needs 'indices' when it has not exactly 3 vertices"},
        {"Shape \"trianglemesh\" \"integer indices\" [0 1 3] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "scene:2:22: triangle 0 refers to vertex 3; the mesh has 3 vertices"},
        {"Shape \"trianglemesh\" \"integer indices\" [0 1 2 -1 0 1] \"point3 P\" [0 0 0 1 0 0 0 1 0]",
         "scene:2:22: triangle 1 refers to vertex -1; the mesh has 3 vertices"},
        {"Scale 1e30 1 1 Scale 1e30 1 1 Shape \"trianglemesh\" \"point3 P\" [1 0 0 1 0 0 0 1 0]",
         "scene:2:31: vertex 0 lies at infinity in world space"},
        {"Shape \"plymesh\"", "scene:2:1: shape 'plymesh' needs a parameter 'filename'"},
        {"Shape \"plymesh\" \"string filename\" \"no/such.ply\"",
         "scene:2:17: there is no file './no/such.ply'"},
        {"Shape \"disk\" \"float innerradius\" 2", "scene:2:14: parameter 'innerradius' is not between 0 and "
                                                   "'radius'"},
        // Transformations.
        {"Translate 1 2 x", "scene:2:15: Translate: expected 3 numbers, read 'x'"},
        {"Translate 1 2", "scene:2:14: Translate: expected 3 numbers, read the end of the file"},
        {"Scale 1 0 1", "scene:2:1: Scale: a factor is 0; the transformation has no inverse"},
        {"Rotate 30 0 0 0", "scene:2:1: Rotate: the axis is the zero vector"},
        {"LookAt 0 0 0 0 0 0 0 1 0",
         "scene:2:1: LookAt: the eye, the target and the up vector span no frame"},
        {"LookAt 0 0 0 0 1 0 0 1 0",
         "scene:2:1: LookAt: the eye, the target and the up vector span no frame"},
        {"Transform 1", "scene:2:11: Transform: expected '[' and 16 numbers, read '1'"},
        {"Transform [1 2]", "scene:2:11: Transform has 2 numbers; expected 16"},
        {"Transform [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0]", "scene:2:1: Transform: the matrix has no inverse"},
        {"ConcatTransform [1 0 0 0 1 0 0 0 0 0 1 0 0 0 0 1]",
         "scene:2:1: ConcatTransform: the matrix has no inverse"},
        {"CoordSysTransform \"worl\"",
         "scene:2:1: there is no coordinate system 'worl' (did you mean 'world'?)"},
        {"ActiveTransform Endtime", "scene:2:17: ActiveTransform 'Endtime'; expected All, StartTime or "
                                    "EndTime (did you mean 'EndTime'?)"},
        {"ActiveTransform EndTime Scale -1 1 1 ActiveTransform All Shape \"sphere\"",
         "scene:2:58: motion: one end is mirrored and the other is not; between them the object would be "
         "flat"},
        {"TransformTimes 0 1", "scene:2:1: 'TransformTimes' is after WorldBegin; it belongs before it"},
        // Blocks.
        {"AttributeEnd", "scene:2:1: AttributeEnd without AttributeBegin"},
        {"AttributeBegin", "scene:2:1: this AttributeBegin has no AttributeEnd"},
        {"ObjectBegin \"a\"", "scene:2:1: this ObjectBegin has no ObjectEnd"},
        {"ObjectEnd", "scene:2:1: ObjectEnd without ObjectBegin"},
        {"AttributeBegin ObjectBegin \"a\" AttributeEnd",
         "scene:2:32: AttributeEnd, but the innermost open block is the ObjectBegin of scene:2:16"},
        {"ObjectBegin \"a\" AttributeBegin ObjectEnd",
         "scene:2:32: ObjectEnd, but the innermost open block is the AttributeBegin of scene:2:17"},
        {"ObjectBegin \"a\" ObjectBegin \"b\"", "scene:2:17: ObjectBegin inside another object's definition"},
        {"ObjectBegin \"a\" ObjectEnd ObjectBegin \"a\"", "scene:2:27: object 'a' is defined twice"},
        {"ObjectBegin \"a\" ObjectInstance \"a\"",
         "scene:2:17: ObjectInstance inside an object's definition"},
        {"ObjectInstance \"tree\"", "scene:2:1: object 'tree' is not defined"},
        {"WorldBegin", "scene:2:1: 'WorldBegin' is after WorldBegin; it belongs before it"},
        {"Film \"rgb\"", "scene:2:1: 'Film' is after WorldBegin; it belongs before it"},
        {"Attribute \"shapes\"",
         "scene:2:1: Attribute of 'shapes'; expected shape, light, material, medium or texture (did you mean "
         "'shape'?)"},
        {"ColorSpace \"sRBG\"", "scene:2:1: unknown colour space 'sRBG' (did you mean 'srgb'?)"},
        // Materials.
        {"Material \"difuse\"", "scene:2:1: unknown material 'difuse' (did you mean 'diffuse'?)"},
        {"MakeNamedMaterial \"m\"", "scene:2:1: named material 'm' needs a parameter 'string type'"},
        {"MakeNamedMaterial \"m\" \"string type\" \"diffuse\" MakeNamedMaterial \"m\" \"string type\" "
         "\"diffuse\"",
         "scene:2:47: material 'm' is defined twice"},
        {"MakeNamedMaterial \"metal\" \"string type\" \"diffuse\" NamedMaterial \"medal\" Shape \"sphere\"",
         "scene:2:73: this shape's material 'medal' is not defined (did you mean 'metal'?)"},
        {"Material \"diffuse\" \"rgb reflectance\" [1 2]",
         "scene:2:20: parameter 'reflectance' has 2 values; expected 3 (R G B)"},
        {"Material \"diffuse\" \"rgb reflectance\" [1 0 -1]",
         "scene:2:20: parameter 'reflectance' has a negative component"},
        {"Material \"diffuse\" \"float reflectance\" 1",
         "scene:2:20: parameter 'reflectance' has type float; expected texture, rgb, spectrum or blackbody"},
        {"Material \"diffuse\" \"spectrum reflectance\" [500]",
         "scene:2:20: parameter 'reflectance' has 1 numbers; expected pairs of wavelength and value"},
        {"Material \"conductor\" \"spectrum eta\" \"metal-Cu-etta\"",
         "scene:2:22: there is no spectrum named 'metal-Cu-etta' (did you mean 'metal-Cu-eta'?)"},
        {"Material \"conductor\" \"spectrum eta\" \"no.spd\"", "scene:2:22: there is no file './no.spd'"},
        {"Material \"conductor\" \"rgb reflectance\" [1 1 1] \"rgb k\" [1 1 1]",
         "scene:2:22: 'reflectance' together with 'eta' or 'k'; expected one or the other"},
        {"Material \"dielectric\" \"float eta\" 0",
         "scene:2:23: parameter 'eta' is no index of refraction; expected 1 positive number"},
        {"Material \"coateddiffuse\" \"float g\" 1.5", "scene:2:26: parameter 'g' is above 1"},
        {"Material \"coateddiffuse\" \"float thickness\" -0.5",
         "scene:2:26: parameter 'thickness' is below 0"},
        {"Material \"conductor\" \"float vroughness\" -0.5", "scene:2:22: parameter 'vroughness' is below 0"},
        {"Material \"diffusetransmission\" \"float scale\" -1", "scene:2:32: parameter 'scale' is below 0"},
        {"Material \"coateddiffuse\" \"integer maxdepth\" 0", "scene:2:26: parameter 'maxdepth' is below 1"},
        // Textures.
        {"Texture \"t\" \"color\" \"imagemap\"",
         "scene:2:1: texture 't' has type 'color'; expected 'float' or 'spectrum'"},
        {"Texture \"t\" \"float\" \"imagmap\"",
         "scene:2:1: unknown texture 'imagmap' (did you mean 'imagemap'?)"},
        {"Texture \"t\" \"float\" \"ptex\" Material \"diffuse\" Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:1: texture 'ptex' is not supported yet"},
        {"Texture \"t\" \"spectrum\" \"fbm\"",
         "scene:2:1: texture 'fbm' has type 'spectrum'; expected 'float'"},
        {"Texture \"t\" \"float\" \"marble\"",
         "scene:2:1: texture 'marble' has type 'float'; expected 'spectrum'"},
        {"Texture \"t\" \"float\" \"fbm\" \"integer octaves\" 65 Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:27: parameter 'octaves' is 65; expected 0 to 64"},
        {"Texture \"t\" \"float\" \"directionmix\" \"vector3 dir\" [ 0 0 0 ] Shape \"sphere\" \"texture "
         "alpha\" "
         "\"t\"",
         "scene:2:36: parameter 'dir' has no direction"},
        {"Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"constant\"",
         "scene:2:32: float texture 't' is defined twice"},
        {"Material \"diffuse\" \"texture reflectance\" \"gird\" Texture \"grid\" \"spectrum\" \"constant\"",
         "scene:2:20: there is no spectrum texture 'gird' (did you mean 'grid'?)"},
        {"Texture \"t\" \"float\" \"constant\" Material \"diffuse\" \"texture reflectance\" \"t\"",
         "scene:2:51: texture 't' is not a spectrum texture, which parameter 'reflectance' needs"},
        {"Texture \"t\" \"float\" \"scale\" \"texture tex\" \"t\" Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:29: texture 't' is not defined before the texture that uses it"},
        {"Texture \"t\" \"float\" \"imagemap\" Shape \"sphere\" \"texture alpha\" \"t\"",
         "scene:2:1: texture 'imagemap' needs a parameter 'filename'"},
        {"Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"no.png\" Shape \"sphere\" \"texture "
         "alpha\" \"t\"",
         "scene:2:32: there is no file './no.png'"},
        {"Texture \"t\" \"float\" \"imagemap\" \"string filename\" \".\" Shape \"sphere\" \"texture alpha\" "
         "\"t\"",
         "scene:2:32: ./.: cannot be read: it is a folder"},
        {"Texture \"t\" \"float\" \"imagemap\" \"string wrap\" \"repeal\" Shape \"sphere\" \"texture alpha\" "
         "\"t\"",
         "scene:2:32: parameter 'wrap' is 'repeal'; expected one of repeat, black, clamp, octahedralsphere, "
         "mirror (did "
         "you mean 'repeat'?)"},
        // Lights.
        {"LightSource \"infinit\"", "scene:2:1: unknown light 'infinit' (did you mean 'infinite'?)"},
        {"LightSource \"projection\"", "scene:2:1: light 'projection' needs a parameter 'filename'"},
        {"LightSource \"projection\" \"float fov\" 180",
         "scene:2:26: parameter 'fov' is not between 0 and 180 degrees"},
        {"LightSource \"goniometric\"", "scene:2:1: light 'goniometric' needs a parameter 'filename'"},
        {"LightSource \"distant\" \"point3 from\" [0 0 1]",
         "scene:2:1: 'from' and 'to' are the same point: the light has no direction"},
        {"LightSource \"spot\" \"float conedeltaangle\" 40",
         "scene:2:20: parameter 'conedeltaangle' is not between 0 and 'coneangle'"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 0 1 1 1 2 2 2]",
         "scene:2:40: parameter 'portal' has 3 points; expected the 4 corners of a rectangle"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 0 1 1]",
         "scene:2:40: parameter 'portal' has 5 numbers; expected a multiple of 3"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 0 1 1 1 1 1 1 0 0 0]",
         "scene:2:40: two corners of the portal are the same point"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1]\n \"point3 portal\" [0 0 0 0 1 0 1 1 0.2 1 0 0]",
         "scene:3:2: the portal is no rectangle: opposite edges are not parallel"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [0 0 0 0.1 1 0 1.1 1 0 1 0 0]",
         "scene:2:40: the portal is no rectangle: edges are not perpendicular"},
        {"LightSource \"infinite\" \"rgb L\" [1 1 1] \"rgb portal\" [0 0 0]",
         "scene:2:40: parameter 'portal' has type rgb; expected point3"},
        {"LightSource \"infinite\" \"point3 portal\" [0 0 0 0 1 0 1 1 0 1 0 0]",
         "scene:2:24: 'portal' without 'filename' or 'L'; expected one of them"},
        {"LightSource \"infinite\" \"string filename\" \"map.exr\"",
         "scene:2:24: there is no file './map.exr'"},
        {"LightSource \"point\" \"blackbody I\" 0",
         "scene:2:21: parameter 'I' is no temperature; expected 1 positive number of kelvins"},
        {"AreaLightSource \"area\"", "scene:2:1: unknown area light 'area'; expected 'diffuse'"},
        {"AreaLightSource \"diffuse\" \"string filename\" \"a.png\"",
         "scene:2:27: there is no file './a.png'"},
        {"AreaLightSource \"diffuse\" \"string filename\" \"a.png\" \"rgb L\" [1 1 1]",
         "scene:2:53: 'L' together with 'filename'; expected one or the other"},
        // Media.
        {"MakeNamedMedium \"a\" \"float g\" 0", "scene:2:1: the medium needs a parameter 'string type'"},
        {"MakeNamedMedium \"a\" \"string type\" \"homogenous\"",
         "scene:2:21: unknown medium 'homogenous' (did you mean 'homogeneous'?)"},
        {"MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"string preset\" \"Aple\"",
         "scene:2:49: there is no medium preset 'Aple' (did you mean 'Apple'?)"},
        {"MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"spectrum sigma_s\" [400 1 700 -1]",
         "scene:2:49: parameter 'sigma_s' is negative or not finite at 551 nm"},
        {"MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"float g\" 1",
         "scene:2:49: parameter 'g' is not between -1 and 1"},
        {"MakeNamedMedium \"a\" \"string type\" \"homogeneous\" \"float scale\" -1",
         "scene:2:49: parameter 'scale' is negative"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\"",
         "scene:2:1: medium 'uniformgrid' needs a parameter 'float density'"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"integer nx\" 2 \"float density\" [1 2 3]",
         "scene:2:64: parameter 'density' has 3 values; expected nx x ny x nz = 2 x 1 x 1"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"float density\" [-1]",
         "scene:2:49: parameter 'density' has a value that is negative or not finite"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"float density\" 1 \"float temperature\" 1 "
         "\"blackbody Le\" 3000",
         "scene:2:89: 'Le' together with 'temperature'; expected one or the other"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"integer nx\" 0",
         "scene:2:49: parameter 'nx' is 0; expected at least 1 sample"},
        {"MakeNamedMedium \"a\" \"string type\" \"uniformgrid\" \"float density\" 1 \"point3 p1\" [0 1 1]",
         "scene:2:67: the box between 'p0' and 'p1' is empty"},
        {"MakeNamedMedium \"a\" \"string type\" \"rgbgrid\"",
         "scene:2:1: medium 'rgbgrid' needs a parameter 'rgb sigma_a' or 'rgb sigma_s'"},
        {"MakeNamedMedium \"a\" \"string type\" \"rgbgrid\" \"rgb sigma_s\" [1 2 3 4]",
         "scene:2:45: parameter 'sigma_s' has 4 numbers; expected a multiple of 3 (R G B)"},
        {"MakeNamedMedium \"a\" \"string type\" \"cloud\" \"float wispiness\" -1",
         "scene:2:43: parameter 'wispiness' is negative"},
        {"Transform [1 0 0 0.5 0 1 0 0 0 0 1 0 0 0 0 1] MakeNamedMedium \"a\" \"string type\" \"cloud\"",
         "scene:2:47: the medium's transformation is projective; expected an affine one"},
        {"MakeNamedMedium \"a\" \"string type\" \"nanovdb\"",
         "scene:2:1: medium 'nanovdb' needs a parameter 'string filename'"},
        {"MakeNamedMedium \"a\" \"string type\" \"nanovdb\" \"string filename\" \"none.nvdb\"",
         "scene:2:45: there is no file './none.nvdb'"},
        {"MediumInterface \"fog\" \"\" Shape \"sphere\"",
         "scene:2:26: this shape's medium 'fog' is not defined"},
        // Files.
        {"Include \"no.pbrt\"", "scene:2:1: there is no file './no.pbrt'"},
        {"Include \"/\"", "scene:2:1: /: cannot be read: it is a folder"},
        {"Include \"\"", "scene:2:1: an empty file name"},
    };
    for (const Case& c : cases) {
        std::string error = world_error(c.text);
        // What the operating system says about a file is not ours.
        if (std::string(c.error).ends_with("it is a folder"))
            EXPECT_EQ(error.substr(0, 10), std::string(c.error).substr(0, 10)) << error;
        else
            EXPECT_EQ(error, c.error) << c.text;
    }
}

TEST(PbrtErrors, SentencesBeforeTheWorld) {
    const Case cases[] = {
        {"", "scene:1:1: the file ends before WorldBegin"},
        {"# nothing\n", "scene:2:1: the file ends before WorldBegin"},
        {"Shape \"sphere\"", "scene:1:1: 'Shape' is before WorldBegin; it belongs after it"},
        {"AttributeBegin", "scene:1:1: 'AttributeBegin' is before WorldBegin; it belongs after it"},
        {"Import \"x\"", "scene:1:1: 'Import' is before WorldBegin; it belongs after it"},
        {"Film \"rgb\" \"integer xresolution\" 0 WorldBegin",
         "scene:1:12: parameter 'xresolution' is 0; expected 1 to 65536 pixels"},
        {"Film \"rgb\" \"integer yresolution\" -5 WorldBegin",
         "scene:1:12: parameter 'yresolution' is -5; expected 1 to 65536 pixels"},
        {"Film \"rgb\" \"integer yresolution\" 2000000000 WorldBegin",
         "scene:1:12: parameter 'yresolution' is 2000000000; expected 1 to 65536 pixels"},
        {"Film \"rgb\" \"float cropwindow\" [0.5 0.5 0 1] WorldBegin",
         "scene:1:12: the crop leaves no pixel of the film"},
        {"Film \"rgb\" \"integer pixelbounds\" [0 1 2] WorldBegin",
         "scene:1:12: parameter 'pixelbounds' has 3 values; expected 4 (x0 x1 y0 y1)"},
        {"Film \"rgb\" \"string sensor\" \"canon_eos_5d_mk2\" WorldBegin",
         "scene:1:12: unknown sensor 'canon_eos_5d_mk2' (did you mean 'canon_eos_5d_mkii'?)"},
        {"Film \"image\" WorldBegin",
         "scene:1:1: unknown film 'image': the file is for pbrt-v3; 'pbrt --upgrade old.pbrt > new.pbrt' of "
         "pbrt-v4 converts it"},
        {"Film \"spectral\" \"integer nbuckets\" 0 WorldBegin",
         "scene:1:17: parameter 'nbuckets' is 0; expected 1 to 512"},
        {"Film \"spectral\" \"float lambdamax\" 900 WorldBegin",
         "scene:1:17: 'lambdamin' and 'lambdamax' must lie between 360 and 830 nm, in this order"},
        {"Camera \"perspectiv\" WorldBegin",
         "scene:1:1: unknown camera 'perspectiv' (did you mean 'perspective'?)"},
        {"Camera \"perspective\" \"integer fov\" 40 WorldBegin",
         "scene:1:22: parameter 'fov' has type integer; expected float"},
        {"Camera \"perspective\" \"float fov\" 180 WorldBegin",
         "scene:1:22: parameter 'fov' is not between 0 and 180 degrees"},
        {"Camera \"perspective\" \"float shutteropen\" 1 \"float shutterclose\" 1 WorldBegin",
         "scene:1:44: the shutter closes before it opens"},
        {"Camera \"realistic\" WorldBegin",
         "scene:1:1: camera 'realistic' needs a parameter 'string lensfile'"},
        {"Sampler \"sobol\" \"integer pixelsamples\" 0 WorldBegin",
         "scene:1:17: parameter 'pixelsamples' is 0; expected at least 1 sample"},
        {"Sampler \"sobol\" \"integer pixelsamples\" -4 WorldBegin",
         "scene:1:17: parameter 'pixelsamples' is -4; expected at least 1 sample"},
        {"Sampler \"stratified\" \"integer xsamples\" 100000 \"integer ysamples\" 100000 WorldBegin",
         "scene:1:22: more than 2147483647 samples"},
        {"Sampler \"sobl\" WorldBegin", "scene:1:1: unknown sampler 'sobl' (did you mean 'sobol'?)"},
        {"Integrator \"pat\" WorldBegin", "scene:1:1: unknown integrator 'pat' (did you mean 'path'?)"},
        {"Integrator \"path\" \"integer maxdepth\" -1 WorldBegin",
         "scene:1:19: parameter 'maxdepth' is negative"},
        {"PixelFilter \"gausian\" WorldBegin",
         "scene:1:1: unknown pixel filter 'gausian' (did you mean 'gaussian'?)"},
        {"PixelFilter \"box\" \"float xradius\" 0 WorldBegin",
         "scene:1:19: parameter 'xradius' must be positive"},
        {"Option \"integer sed\" 4", "scene:1:8: unknown option 'sed' (did you mean 'seed'?)"},
        {"Option", "scene:1:1: Option has 0 parameters; expected 1"},
    };
    for (const Case& c : cases) EXPECT_EQ(error_of(c.text), c.error) << c.text;
}

TEST(PbrtErrors, DeepNestingIsFine) {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += "AttributeBegin ";
    for (int i = 0; i < 100000; ++i) text += "AttributeEnd ";
    EXPECT_EQ(world_error(text), "");
}

TEST(PbrtErrors, TextureTreesAreBounded) {
    std::string text = "Texture \"t0\" \"float\" \"constant\"\n";
    for (int i = 1; i < 100; ++i)
        text += "Texture \"t" + std::to_string(i) + "\" \"float\" \"scale\" \"texture tex\" \"t" +
                std::to_string(i - 1) + "\"\n";
    EXPECT_NE(
        world_error(text + "Shape \"sphere\" \"texture alpha\" \"t99\"").find("more than 64 levels deep"),
        std::string::npos);
    EXPECT_EQ(world_error(text + "Shape \"sphere\" \"texture alpha\" \"t60\""), "");
}

TEST(PbrtWarnings, UnknownParametersOnceForEachPluginAndName) {
    Warnings warnings;
    parse_world("LightSource \"point\"\n"
                "Shape \"sphere\" \"float raduis\" 1\nShape \"sphere\" \"float raduis\" 2\n"
                "Shape \"disk\" \"float raduis\" 1\nMaterial \"diffuse\" \"float roughness\" 1\n",
                &warnings);
    EXPECT_EQ(
        warnings.messages(),
        (std::vector<std::string>{
            "scene:3:16: shape 'sphere' has no parameter 'raduis' (did you mean 'radius'?); it is ignored",
            "scene:5:14: shape 'disk' has no parameter 'raduis' (did you mean 'radius'?); it is ignored",
            "scene:6:20: material 'diffuse' has no parameter 'roughness'; it is ignored"}));
}

} // namespace
} // namespace montelux
