//! The keys of shapes.

use super::Key;
use super::Need::{Optional, Required};

keys!(KEYS, "Keys of shapes, shape by shape.":
"surface" "plane": {
    Optional "point_m", "a point of it, `[0, 0, 0]` by default";
    Optional "normal", "outward, of any length, `[0, 0, 1]` by default";
}
"surface" "disk": {
    Optional "centre_m", "`[0, 0, 0]` by default";
    Optional "normal", "outward, of any length, `[0, 0, 1]` by default";
    Required "radius_m", "of the plate";
}
"surface" "rectangle": {
    Optional "centre_m", "`[0, 0, 0]` by default";
    Required "first_half_edge_m", "from the centre to the middle of an edge";
    Required "second_half_edge_m", "to the middle of the next, at right angles; the first times the second is outward";
}
"surface" "sphere": {
    Optional "centre_m", "`[0, 0, 0]` by default";
    Required "radius_m", "of the sphere";
    Optional "pole", "direction of the tip, the middle of the map, `[0, 0, 1]` by default";
    Optional "active_half_angle_deg", "only points within this angle of the pole may touch; all by default";
}
"surface" "ellipsoid": {
    Required "semi_axes_m", "three, along x, y and z";
}
"surface" "cylinder": {
    Optional "centre_m", "a point of the axis, the middle of the active part, `[0, 0, 0]` by default";
    Optional "axis", "its direction, of any length, `[0, 0, 1]` by default";
    Required "radius_m", "of the cylinder";
    Optional "half_length_m", "only points within this height above and below the centre may touch; all by default";
}
"surface" "capped_cylinder": {
    Optional "centre_m", "`[0, 0, 0]` by default";
    Optional "axis", "of any length, `[0, 0, 1]` by default";
    Required "radius_m", "of the cylinder";
    Required "half_length_m", "from the centre to the flat ends";
}
"surface" "elliptic_cylinder": {
    Required "semi_axes_m", "two, across z";
    Required "ends_m", "`\"unbounded\"`, `{ open = 0.01 }` or `{ capped = 0.01 }`";
}
"surface" "capsule": {
    Optional "centre_m", "`[0, 0, 0]` by default";
    Optional "axis", "of any length, `[0, 0, 1]` by default";
    Required "radius_m", "of cylinder and ends";
    Required "half_length_m", "of the straight part";
}
"surface" "cone": {
    Optional "apex_m", "the tip, `[0, 0, 0]` by default";
    Optional "axis", "from the tip into the cone, of any length, `[0, 0, 1]` by default";
    Required "half_angle_deg", "between axis and side";
    Optional "depth_m", "from the tip to where it ends; without it, it does not end";
}
"surface" "frustum": {
    Optional "base_centre_m", "`[0, 0, 0]` by default";
    Optional "axis", "from base to top, of any length, `[0, 0, 1]` by default";
    Required "base_radius_m", "at the base";
    Required "top_radius_m", "at the top";
    Required "height_m", "from base to top";
}
"surface" "torus": {
    Required "ring_radius_m", "from the z axis to the middle of the tube";
    Required "tube_radius_m", "of the tube";
}
"surface" "superquadric": {
    Required "semi_axes_m", "three, along x, y and z";
    Required "exponents", "two: north-south and east-west; 1 is round, towards 0 a box, 2 an octahedron";
}
"surface" "rounded_box": {
    Required "half_extents_m", "three, along x, y and z, rounding included";
    Required "rounding_m", "radius of the edges";
}
"surface" "paraboloid": {
    Required "radii_m", "two, of curvature at the apex";
    Optional "depth_m", "from the apex to the rim; without it, it does not end";
}
"surface" "revolution": {
    Required "profile_m", "points `[z, radius]` that are joined smoothly, turned about the z axis";
}
"surface" "heightfield": {
    Required "corner_m", "`[x, y]` of the first height";
    Required "spacing_m", "between heights along x and y";
    Required "columns", "heights along x";
    Required "heights_m", "row by row";
}
"surface" "mesh": {
    Optional "file", "in place of corners and triangles: an `.stl` or `.obj` file, relative to the scene; the mesh must be closed";
    Optional "metres_per_unit", "required with `file`, the unit of it: 0.001 for millimetres";
    Required "vertices_m", "the corners; not with a file";
    Required "triangles", "three corners each, counted from 0, counterclockwise seen from outside; not with a file";
}
"surface" "formula": {
    Required "outside", "a formula of x, y and z \\[m\\] that is positive outside of the body and negative inside, with `+ - * / ^`, `sqrt`, `abs`, `exp`, `sin`, `cos`, `min(a, b)` (the union), `max(a, b)` (what both have in common) and `pi`";
    Optional "parameters", "numbers that the formula names";
    Optional "centre_m", "of a ball around the whole surface, `[0, 0, 0]` by default";
    Required "reach_m", "radius of that ball";
    Optional "convex", "`true` if it is, which makes soft fingers a hundred times faster";
    Optional "steepest_per_m", "no gradient of the formula in the ball is longer; needed only where it divides by zero, or takes the root of zero, on the surface";
}
"surface" "posed": {
    Required "surface", "another shape";
    Optional "translation_m", "`[0, 0, 0]` by default";
    Optional "rotation_deg", "a rotation vector, axis times angle, `[0, 0, 0]` by default";
}
"surface" "trimmed": {
    Required "surface", "another shape";
    Required "region", "the half-space that is kept: `point_m`, `inward`";
}
"surface" "compound": {
    Required "parts", "a list of shapes";
}
);
