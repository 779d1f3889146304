// The clipping plane: what lies beyond it is not drawn, and not found by the pointer.
import { Vector4 } from 'three';

/** GLSL for vertices: `place` as a varying; for fragments: nothing beyond the plane. */
export const kClipVertex = `
  varying vec3 vPlace;`;
/** GLSL for fragments: nothing beyond the plane. */
export const kClipFragment = `
  uniform vec4 clip;
  varying vec3 vPlace;
  bool clipped() {
    return dot(clip.xyz, vPlace) > clip.w;
  }`;

/** The plane, as shaders and as the pointer know it. */
export class Clip {
  constructor() {
    this.uniform = { value: new Vector4(0, 0, 0, 1) }; // nothing lies beyond
  }

  // axis: 0, 1 or 2, or -1 for no plane; at: page units; beyond: +1 hides what lies above it, -1 what lies below.
  set(axis, at, beyond) {
    if (axis < 0) this.uniform.value.set(0, 0, 0, 1);
    else this.uniform.value.set(...[0, 1, 2].map((c) => (c === axis ? beyond : 0)), beyond * at);
  }

  hides(x, y, z) {
    const plane = this.uniform.value;
    return plane.x * x + plane.y * y + plane.z * z > plane.w;
  }
}
