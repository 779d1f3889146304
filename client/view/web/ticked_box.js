// The body's box with a tick at every round coordinate, drawn in the scene.
import { BufferAttribute, BufferGeometry, Group, LineBasicMaterial, LineSegments, Vector3 } from 'three';
import { roundLength } from './numbers.js';

const kTickLength = 0.03;
const kTicksAimedAt = 12; // along the longest side; round distances give 6 to 16
const kMinLength = 0.05; // of an axis seen on the screen, as a share of itself: shorter ones get no numbers

function boxEdges(half) {
  const ends = [];
  for (let axis = 0; axis < 3; ++axis) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const [su, sv] of [
      [-1, -1],
      [-1, 1],
      [1, -1],
      [1, 1],
    ]) {
      for (const s of [-1, 1]) {
        const end = [0, 0, 0];
        end[axis] = s * half[axis];
        end[u] = su * half[u];
        end[v] = sv * half[v];
        ends.push(...end);
      }
    }
  }
  return ends;
}

// The multiples of `distance` on a side of the box: `coordinate` in mesh units, `at` in page units, and which
// multiple it is.
function ticksOf(half, centre, unit, distance) {
  const ticks = [];
  const last = Math.floor((centre + half * unit) / distance + 1e-9);
  for (let k = Math.ceil((centre - half * unit) / distance - 1e-9); k <= last; ++k) {
    const coordinate = Number((k * distance).toPrecision(12));
    ticks.push({ coordinate, index: k, at: (coordinate - centre) / unit });
  }
  return ticks;
}

const lines = (material) => new LineSegments(new BufferGeometry(), material);

function setLines(object, ends) {
  object.geometry.setAttribute('position', new BufferAttribute(new Float32Array(ends), 3));
}

/** Edges and ticks; the numbers are those of ticks.js. */
export class TickedBox {
  // half: half sides, page units; centre: of the box, mesh units; unit: mesh units per page unit.
  constructor(half, centre, unit) {
    this.half = half;
    this.unit = unit;
    this.tickDistance = roundLength((4 * unit * Math.max(...half)) / kTicksAimedAt); // mesh units
    this.ticks = half.map((h, axis) => ticksOf(h, centre[axis], unit, this.tickDistance));
    this.material = new LineBasicMaterial({ transparent: true, opacity: 0.28 });
    this.edgeLines = lines(this.material);
    setLines(this.edgeLines, boxEdges(half));
    this.marks = lines(this.material);
    this.marks.frustumCulled = false; // moves from edge to edge, its bounds with it
    this.object = new Group();
    this.object.add(this.edgeLines, this.marks);
    for (const part of this.object.children) part.renderOrder = 5;
    this.edges = [];
  }

  /** @param {Theme} theme */
  paint(theme) {
    this.material.color.set(theme.ink);
  }

  /**
   * Moves the ticks of each axis to the edge of the box that lies lowest on the screen or, where the axis stands
   * upright, leftmost.  `edges` then holds per axis `foot` (a point of the edge, page units), `tick` (from foot
   * to tip) and `outward` (on the screen, y up); null for an axis that points at the viewer.
   * @param {import('three').Camera} camera
   */
  look(camera) {
    const onScreen = [0, 1, 2].map((axis) =>
      new Vector3(...[0, 1, 2].map((c) => (c === axis ? 1 : 0))).transformDirection(camera.matrixWorldInverse),
    );
    this.edges = [0, 1, 2].map((axis) => this.edgeOf(axis, onScreen));
    const key = JSON.stringify(this.edges.map((edge) => edge && [edge.foot, edge.tick]));
    if (key === this.key) return;
    this.key = key;
    const ends = [];
    this.edges.forEach((edge, axis) => {
      if (!edge) return;
      for (const { at } of this.ticks[axis]) {
        const foot = this.placeOn(edge, axis, at);
        ends.push(...foot, ...foot.map((c, i) => c + edge.tick[i]));
      }
    });
    setLines(this.marks, ends);
  }

  edgeOf(axis, onScreen) {
    const along = onScreen[axis];
    const length = Math.hypot(along.x, along.y);
    if (length < kMinLength) return null;
    let outward = [-along.y / length, along.x / length];
    const lying = Math.abs(along.x) >= Math.abs(along.y);
    if (outward[lying ? 1 : 0] > 0) outward = outward.map((c) => -c);
    const foot = [0, 0, 0];
    let tick = null;
    let steepest = -1;
    for (const other of [(axis + 1) % 3, (axis + 2) % 3]) {
      const reach = onScreen[other].x * outward[0] + onScreen[other].y * outward[1];
      const side = reach >= 0 ? 1 : -1;
      foot[other] = side * this.half[other];
      if (Math.abs(reach) <= steepest) continue;
      steepest = Math.abs(reach);
      tick = [0, 0, 0];
      tick[other] = side * kTickLength;
    }
    return { foot, tick, outward, length };
  }

  placeOn(edge, axis, at) {
    const place = edge.foot.slice();
    place[axis] = at;
    return place;
  }
}
