// The skeleton as a triangulated sheet, for the operator `chords`.
import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, ShaderMaterial } from 'three';
import { descending } from './decode.js';

const kVertexShader = `
  attribute vec4 colour;
  varying vec3 vColour, vAt;
  void main() {
    vColour = colour.rgb;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    vAt = at.xyz;
    gl_Position = projectionMatrix * at;
  }`;

const kFragmentShader = `
  uniform float lift;
  varying vec3 vColour, vAt;
  void main() {
    vec3 n = normalize(cross(dFdx(vAt), dFdy(vAt)));
    if (n.z < 0.0) n = -n;
    float lit = max(0.0, dot(n, vec3(-0.42, 0.55, 0.72)));
    gl_FragColor = vec4((vColour + lift * (1.0 - vColour)) * (0.55 + 0.45 * lit), 1.0);
  }`;

export class Sheet {
  // pieces: per triangle its piece, the heaviest is 0.
  constructor(positions, colours, pieces, corners) {
    // Lightest pieces last: the slider moves the end of what is drawn.
    this.order = descending(Int32Array.from(pieces, (piece) => -piece));
    const index = new Uint32Array(corners.length);
    this.order.forEach((t, place) => index.set(corners.subarray(3 * t, 3 * t + 3), 3 * place));
    this.geometry = new BufferGeometry();
    this.geometry.setAttribute('position', new BufferAttribute(positions, 3));
    this.geometry.setAttribute('colour', new BufferAttribute(colours, 4, true));
    this.geometry.setIndex(new BufferAttribute(index, 1));
    this.uniforms = { lift: { value: 0 } };
    this.object = new Mesh(
      this.geometry,
      new ShaderMaterial({
        vertexShader: kVertexShader,
        fragmentShader: kFragmentShader,
        uniforms: this.uniforms,
        side: DoubleSide,
        extensions: { derivatives: true },
      }),
    );
    this.object.frustumCulled = false;
  }

  showFirst(triangles) {
    this.geometry.setDrawRange(0, 3 * triangles);
  }

  look() {}

  paint(theme) {
    this.uniforms.lift.value = theme.lift;
  }
}
