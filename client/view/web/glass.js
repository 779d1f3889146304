// A closed surface as glass: clear where it faces the viewer, denser towards the outline.
import {
  BackSide,
  BufferAttribute,
  BufferGeometry,
  Color,
  FrontSide,
  Group,
  Mesh,
  ShaderMaterial,
} from 'three';
import { kClipFragment, kClipVertex } from './clip.js';
import { firstHit } from './ray.js';

const kCreaseCosine = 0.643; // of 50 degrees: sharper edges stay sharp

const kVertexShader = `
  attribute vec3 tint;
  varying vec3 vNormal, vTint;
  ${kClipVertex}
  void main() {
    vTint = tint;
    vNormal = normalMatrix * normal;
    vPlace = position;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const kFragmentShader = `
  uniform vec3 dark, light;
  uniform float clear, rim, fade, solid, tinted;
  varying vec3 vNormal, vTint;
  ${kClipFragment}
  void main() {
    if (clipped()) discard;
    vec3 n = normalize(vNormal);
    if (n.z < 0.0) n = -n;
    float lit = clamp(dot(n, vec3(-0.42, 0.55, 0.72)), 0.0, 1.0);
    float glass = fade * (clear + rim * pow(1.0 - n.z, 2.5));
    vec3 colour = mix(mix(dark, light, lit), (0.6 + 0.4 * lit) * vTint, tinted);
    gl_FragColor = vec4(colour, mix(glass, 1.0, solid));
  }`;

// Twice the area times the normal, per triangle.
function areaVectors(points, corners) {
  const areas = new Float32Array(corners.length);
  for (let t = 0; t < corners.length; t += 3) {
    const [a, b, c] = [3 * corners[t], 3 * corners[t + 1], 3 * corners[t + 2]];
    const u = [points[b] - points[a], points[b + 1] - points[a + 1], points[b + 2] - points[a + 2]];
    const v = [points[c] - points[a], points[c + 1] - points[a + 1], points[c + 2] - points[a + 2]];
    areas[t] = u[1] * v[2] - u[2] * v[1];
    areas[t + 1] = u[2] * v[0] - u[0] * v[2];
    areas[t + 2] = u[0] * v[1] - u[1] * v[0];
  }
  return areas;
}

// The corners round every vertex v: corner[start[v]] .. corner[start[v + 1] - 1].
function cornersAround(corners, vertices) {
  const start = new Uint32Array(vertices + 1);
  for (const v of corners) ++start[v + 1];
  for (let v = 0; v < vertices; ++v) start[v + 1] += start[v];
  const next = start.slice();
  const corner = new Uint32Array(corners.length);
  corners.forEach((v, c) => (corner[next[v]++] = c));
  return { start, corner };
}

// One normal per corner: the area-weighted mean over the triangles round the vertex that meet without a
// crease.
function cornerNormals(points, corners) {
  const areas = areaVectors(points, corners);
  const around = cornersAround(corners, points.length / 3);
  const normals = new Float32Array(3 * corners.length);
  const length = (t) => Math.hypot(areas[t], areas[t + 1], areas[t + 2]);
  for (let c = 0; c < corners.length; ++c) {
    const own = c - (c % 3);
    for (let i = around.start[corners[c]]; i < around.start[corners[c] + 1]; ++i) {
      const other = around.corner[i] - (around.corner[i] % 3);
      const cosine =
        areas[own] * areas[other] + areas[own + 1] * areas[other + 1] + areas[own + 2] * areas[other + 2];
      if (other !== own && cosine <= kCreaseCosine * length(own) * length(other)) continue;
      for (let k = 0; k < 3; ++k) normals[3 * c + k] += areas[other + k];
    }
    const size = Math.hypot(normals[3 * c], normals[3 * c + 1], normals[3 * c + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[3 * c + k] /= size;
  }
  return normals;
}

/** One surface, that of the body or of an eroded solid. */
export class Glass {
  /**
   * points: 3 per vertex, page units; corners: 3 per triangle; order: of drawing, two numbers from it on.
   * @param {import('./clip.js').Clip} clip
   */
  constructor(points, corners, clip, order) {
    this.points = points;
    this.corners = corners;
    this.clip = clip;
    const positions = new Float32Array(3 * corners.length);
    corners.forEach((v, c) => positions.set(points.subarray(3 * v, 3 * v + 3), 3 * c));
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(cornerNormals(points, corners), 3));
    this.tints = new BufferAttribute(new Float32Array(3 * corners.length), 3);
    geometry.setAttribute('tint', this.tints);
    this.uniforms = {
      dark: { value: new Color() },
      light: { value: new Color() },
      clear: { value: 0 },
      rim: { value: 0 },
      fade: { value: 1 },
      solid: { value: 0 },
      tinted: { value: 0 },
      clip: clip.uniform,
    };
    this.object = new Group();
    // The far wall first, so that triangles need no sorting.
    [BackSide, FrontSide].forEach((side, place) => {
      const material = new ShaderMaterial({
        vertexShader: kVertexShader,
        fragmentShader: kFragmentShader,
        uniforms: this.uniforms,
        side,
        transparent: true,
        depthWrite: false,
      });
      const mesh = new Mesh(geometry, material);
      mesh.renderOrder = order + place;
      this.object.add(mesh);
    });
  }

  // look: how dark, light, clear and dense at its rim it is.
  paint({ dark, light, clear, rim }) {
    this.uniforms.dark.value.setRGB(...dark);
    this.uniforms.light.value.setRGB(...light);
    this.uniforms.clear.value = clear;
    this.uniforms.rim.value = rim;
  }

  /**
   * Gives every triangle a colour of its own, red, green and blue, 0 .. 1; null: none.
   * @param {((triangle: number) => ArrayLike<number>) | null} colourOf
   */
  tint(colourOf) {
    this.uniforms.tinted.value = colourOf ? 1 : 0;
    if (!colourOf) return;
    for (let c = 0; c < this.corners.length; ++c) this.tints.array.set(colourOf(Math.floor(c / 3)), 3 * c);
    this.tints.needsUpdate = true;
  }

  // glass: 1 = as usual, less = fainter; solid: from glass (0) to opaque (1).
  fade(glass, solid) {
    this.uniforms.fade.value = glass;
    this.uniforms.solid.value = solid;
    for (const { material } of this.object.children) material.depthWrite = solid >= 1;
  }

  /**
   * Where a ray meets it first, see firstHit.
   * @param {Ray} ray
   */
  pick(ray) {
    return firstHit(this.points, this.corners, this.corners.length, ray, (...at) => this.clip.hides(...at));
  }
}
