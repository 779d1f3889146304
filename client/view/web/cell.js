// The shape in which a sample point is drawn: a ball, stretched with the cell of the lattice to an ellipsoid.
// So the gaps between neighbours look alike along every axis, however long its steps are.
import { Matrix3, Vector3 } from 'three';

/** GLSL for the fragments of a point of `size` pixels.  Points are at least two pixels large. */
export const kOnEllipsoid = `
  uniform mat3 unstretch;
  uniform float size, pixels;
  // Pixels from the centre, to the right and up.
  vec2 fromCentre() {
    return vec2(gl_PointCoord.x - 0.5, 0.5 - gl_PointCoord.y) * size;
  }
  // The line of sight in the ball's coordinates: at + t * along.  Returns the discriminant of its intersection
  // with the unit ball; negative: it misses.
  float enter(out vec3 at, out vec3 along, out float middle) {
    at = unstretch * vec3(fromCentre() / pixels, 0.0);
    along = unstretch[2];
    middle = dot(at, along);
    return middle * middle - dot(along, along) * (dot(at, at) - 1.0);
  }
  bool outside() {
    vec3 at, along;
    float middle;
    return enter(at, along, middle) < 0.0 && length(fromCentre()) > 1.0;
  }
  vec3 normalOfEllipsoid() {
    vec3 at, along;
    float middle;
    float rest = enter(at, along, middle);
    if (rest < 0.0) return vec3(0.0, 0.0, 1.0);
    return normalize((at + along * ((sqrt(rest) - middle) / dot(along, along))) * unstretch);
  }`;

/** One shape for all points: the cell, shrunk, as the camera sees it. */
export class CellShape {
  // cell: three edges, page units; share: the ellipsoid's half axes in edges.
  constructor(cell, share) {
    const [a, b, c] = cell.map((edge) => new Vector3(...edge));
    this.edge = Math.cbrt(Math.abs(a.dot(b.clone().cross(c)))); // of a cube of the same volume
    this.halfAxes = [a, b, c].map((edge) => edge.multiplyScalar(share));
    // unstretch: from page units in the viewer's directions to the unit ball.
    this.uniforms = { unstretch: { value: new Matrix3() }, size: { value: 2 }, pixels: { value: 1 } };
  }

  /**
   * Before a frame.  pixels: of the drawing buffer, per page unit.
   * @param {import('three').Camera} camera
   * @param {number} pixels
   */
  look(camera, pixels) {
    const turn = new Matrix3().setFromMatrix4(camera.matrixWorldInverse);
    const seen = this.halfAxes.map((axis) => axis.clone().applyMatrix3(turn));
    const stretch = new Matrix3().set(...['x', 'y', 'z'].flatMap((c) => seen.map((axis) => axis[c])));
    const reach = Math.max(...['x', 'y'].map((c) => Math.hypot(...seen.map((axis) => axis[c]))));
    this.uniforms.unstretch.value.getInverse(stretch);
    this.uniforms.size.value = Math.max(2, 2 * reach * pixels);
    this.uniforms.pixels.value = pixels;
  }
}
