// Sample points as balls, stretched like the cells of the lattice.  The points have a fixed order, and a slider
// only moves the end of what is drawn.
import { BufferAttribute, BufferGeometry, Points, ShaderMaterial } from 'three';
import { CellShape, kOnEllipsoid } from './cell.js';
import { kClipFragment, kClipVertex } from './clip.js';

const kHalfAxes = 0.55; // of a ball, in steps of the lattice

const kBallVertex = `
  attribute vec4 colour;
  uniform float size;
  varying vec3 vColour;
  ${kClipVertex}
  void main() {
    vColour = colour.rgb;
    vPlace = position;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
    gl_PointSize = size;
  }`;

const kBallFragment = `
  uniform float lift;
  varying vec3 vColour;
  ${kOnEllipsoid}
  ${kClipFragment}
  void main() {
    if (clipped() || outside()) discard;
    float lit = max(0.0, dot(normalOfEllipsoid(), vec3(-0.42, 0.55, 0.72)));
    float shade = mix(1.0, 0.55 + 0.45 * lit, smoothstep(2.0, 6.0, size));
    gl_FragColor = vec4((vColour + lift * (1.0 - vColour)) * shade, 1.0);
  }`;

/** The sample points of a skeleton, most significant first. */
export class BallCloud {
  /**
   * cell: the steps of the lattice, page units.
   * @param {import('./clip.js').Clip} clip
   */
  constructor(positions, colours, cell, clip) {
    this.positions = positions;
    this.clip = clip;
    this.shape = new CellShape(cell, kHalfAxes);
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('colour', new BufferAttribute(colours, 4, true));
    this.uniforms = { ...this.shape.uniforms, lift: { value: 0 }, clip: clip.uniform };
    this.object = new Points(
      this.geometry,
      new ShaderMaterial({
        vertexShader: kBallVertex,
        fragmentShader: kBallFragment,
        uniforms: this.uniforms,
      }),
    );
    this.object.frustumCulled = false; // what is drawn is a part of the geometry
  }

  showFirst(count) {
    this.shown = count;
    this.thin(1);
  }

  /**
   * Draws one of `every` points of those that are shown.
   * @param {number} every
   */
  thin(every) {
    const indices = every > 1 && Uint32Array.from({ length: Math.ceil(this.shown / every) }, (_, i) => i * every);
    this.geometry.setIndex(indices ? new BufferAttribute(indices, 1) : null);
    this.geometry.setDrawRange(0, indices ? indices.length : this.shown);
  }

  // The point that a ray meets first: its index, or -1.  The balls are taken as round.
  pick({ origin, along }) {
    const radius = kHalfAxes * this.shape.edge;
    let nearest = -1;
    let least = Infinity;
    for (let p = 0; p < this.shown; ++p) {
      const [x, y, z] = this.positions.subarray(3 * p, 3 * p + 3);
      if (this.clip.hides(x, y, z)) continue;
      const [dx, dy, dz] = [x - origin.x, y - origin.y, z - origin.z];
      const depth = dx * along.x + dy * along.y + dz * along.z;
      const away = dx * dx + dy * dy + dz * dz - depth * depth;
      if (away > radius * radius || depth >= least) continue;
      least = depth;
      nearest = p;
    }
    return nearest;
  }

  /**
   * pixels: of the drawing buffer, per page unit.
   * @param {import('three').Camera} camera
   * @param {number} pixels
   */
  look(camera, pixels) {
    this.shape.look(camera, pixels);
  }

  /** @param {Theme} theme */
  paint(theme) {
    this.uniforms.lift.value = theme.lift;
  }
}
