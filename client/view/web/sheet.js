// The skeleton as a triangulated sheet, for the operators `chords` and `ridge`, with the curves of the latter as
// tubes.
import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, ShaderMaterial, Vector3 } from 'three';
import { kClipFragment, kClipVertex } from './clip.js';
import { descending } from './decode.js';
import { firstHit } from './ray.js';

const kVertexShader = `
  attribute vec4 colour;
  varying vec3 vColour, vAt;
  ${kClipVertex}
  void main() {
    vColour = colour.rgb;
    vPlace = position;
    vec4 at = modelViewMatrix * vec4(position, 1.0);
    vAt = at.xyz;
    gl_Position = projectionMatrix * at;
  }`;

const kFragmentShader = `
  uniform float lift;
  varying vec3 vColour, vAt;
  ${kClipFragment}
  void main() {
    if (clipped()) discard;
    vec3 n = normalize(cross(dFdx(vAt), dFdy(vAt)));
    if (n.z < 0.0) n = -n;
    float lit = max(0.0, dot(n, vec3(-0.42, 0.55, 0.72)));
    gl_FragColor = vec4((vColour + lift * (1.0 - vColour)) * (0.55 + 0.45 * lit), 1.0);
  }`;

const kSides = 6;
const kSpotRadius = 0.02; // page units: half of what page.cc says

// What of `a` is written for each segment: one entry of `size` numbers for each of its ends and each side.
function onTubes(a, size, segments, entry) {
  const all = new a.constructor(a.length + segments.length * kSides * size);
  all.set(a);
  segments.forEach((vertex, end) => {
    for (let side = 0; side < kSides; ++side) {
      entry(vertex, end, side).forEach((value, c) => {
        all[a.length + (end * kSides + side) * size + c] = value;
      });
    }
  });
  return all;
}

// Along a segment; a segment without length is a spot, as long as it is wide.
const along = (from, to) => (from.equals(to) ? new Vector3(0, 0, 1) : to.clone().sub(from).normalize());

// The unit vectors across a segment, for the sides of its tube.
function across(direction) {
  const least = Math.abs(direction.x) < 0.6 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
  const first = least.cross(direction).normalize();
  const second = direction.clone().cross(first);
  return Array.from({ length: kSides }, (_, side) => {
    const angle = (2 * Math.PI * side) / kSides;
    return first.clone().multiplyScalar(Math.cos(angle)).addScaledVector(second, Math.sin(angle));
  });
}

function tubePositions(positions, segments, radius) {
  const place = (vertex) => new Vector3().fromArray(positions, 3 * vertex);
  const tubes = [];
  for (let s = 0; s < segments.length; s += 2) {
    const direction = along(place(segments[s]), place(segments[s + 1]));
    const beyond = segments[s] === segments[s + 1] ? kSpotRadius : 0;
    tubes.push({
      sides: across(direction).map((side) => side.multiplyScalar(beyond || radius)),
      ends: [-beyond, beyond].map((by) => direction.clone().multiplyScalar(by)),
    });
  }
  return onTubes(positions, 3, segments, (vertex, end, side) => {
    const { sides, ends } = tubes[end >> 1];
    return place(vertex).add(sides[side]).add(ends[end & 1]).toArray();
  });
}

const tubeColours = (colours, segments) =>
  onTubes(colours, 4, segments, (vertex) => colours.subarray(4 * vertex, 4 * vertex + 4));

// The corners of the triangles of a tube whose vertices begin at `first`; a spot's ends are closed.
function tubeCorners(first, isSpot) {
  const corners = [];
  for (let side = 1; isSpot && side + 1 < kSides; ++side) {
    for (const end of [first, first + kSides]) corners.push(end, end + side, end + side + 1);
  }
  for (let side = 0; side < kSides; ++side) {
    const a = first + side;
    const b = first + ((side + 1) % kSides);
    corners.push(a, b, a + kSides, b, b + kSides, a + kSides);
  }
  return corners;
}

/** Triangles, and tubes about segments, by the weight of their pieces. */
export class Sheet {
  /**
   * The elements are the triangles, then the segments of curves, of which those from a vertex to itself are spots.
   * pieces: per element its piece, the heaviest is 0.  radius: of the tubes, page units.
   * @param {import('./clip.js').Clip} clip
   */
  constructor(positions, colours, pieces, corners, segments, radius, clip) {
    this.clip = clip;
    // Lightest pieces last: the slider moves the end of what is drawn.
    this.order = descending(Int32Array.from(pieces, (piece) => -piece));
    const triangles = corners.length / 3;
    const first = positions.length / 3;
    const index = [];
    this.ends = [0]; // how much of the index the first elements take
    this.kinds = []; // of the elements: triangle, segment or spot
    for (const e of this.order) {
      const tube = e - triangles;
      const isSpot = tube >= 0 && segments[2 * tube] === segments[2 * tube + 1];
      const tubeFirst = first + 2 * kSides * tube;
      index.push(...(tube < 0 ? corners.subarray(3 * e, 3 * e + 3) : tubeCorners(tubeFirst, isSpot)));
      this.kinds.push(tube < 0 ? 'triangle' : isSpot ? 'spot' : 'segment');
      this.ends.push(index.length);
    }
    this.drawn = 0; // of the index
    this.geometry = new BufferGeometry();
    const places = tubePositions(positions, segments, radius);
    this.places = places;
    // Which vertex of the sheet a vertex of what is drawn stands for.
    this.vertexOf = onTubes(Uint32Array.from({ length: first }, (_, v) => v), 1, segments, (vertex) => [vertex]);
    this.index = Uint32Array.from(index);
    this.geometry.setAttribute('position', new BufferAttribute(places, 3));
    this.geometry.setAttribute('colour', new BufferAttribute(tubeColours(colours, segments), 4, true));
    this.geometry.setIndex(new BufferAttribute(this.index, 1));
    this.uniforms = { lift: { value: 0 }, clip: clip.uniform };
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

  /**
   * How many of the first elements are of a kind.
   * @param {number} elements
   * @param {'triangle' | 'segment' | 'spot'} kind
   */
  count(elements, kind) {
    return this.kinds.slice(0, elements).filter((each) => each === kind).length;
  }

  showFirst(elements) {
    this.drawn = this.ends[elements];
    this.geometry.setDrawRange(0, this.drawn);
  }

  /**
   * Where a ray meets it first, see firstHit; the vertices are those of the sheet.
   * @param {Ray} ray
   */
  pick(ray) {
    const hit = firstHit(this.places, this.index, this.drawn, ray, (...at) => this.clip.hides(...at));
    return hit && { ...hit, vertices: hit.vertices.map((v) => this.vertexOf[v]) };
  }

  look() {}

  thin() {}

  /** @param {Theme} theme */
  paint(theme) {
    this.uniforms.lift.value = theme.lift;
  }
}
