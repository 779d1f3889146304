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

// Per triangle the least strength of its corners: it is shown while all three are.
function faceStrengths(strengths, corners) {
  const least = new Float32Array(corners.length / 3);
  for (let t = 0; t < least.length; ++t) {
    least[t] = Math.min(...[0, 1, 2].map((c) => strengths[corners[3 * t + c]]));
  }
  return least;
}

export class Sheet {
  constructor(positions, colours, strengths, corners) {
    const faces = faceStrengths(strengths, corners);
    const order = descending(faces);
    this.strengths = Float32Array.from(order, (t) => faces[t]); // descending
    const index = new Uint32Array(corners.length);
    order.forEach((t, place) => index.set(corners.subarray(3 * t, 3 * t + 3), 3 * place));
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

  scale() {}

  paint(theme) {
    this.uniforms.lift.value = theme.lift;
  }
}
