// The body's box with a tick at every round length, drawn in the scene.
import { BufferAttribute, BufferGeometry, LineBasicMaterial, LineSegments } from 'three';
import { roundLength } from './numbers.js';

const kTickLength = 0.03;
const kMostTicks = 12; // along the longest side

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

// Ticks on the three edges at the lowest corner, pointing outward; they count from that corner.
function ticks(half, distance) {
  const ends = [];
  for (let axis = 0; axis < 3; ++axis) {
    const u = (axis + 1) % 3;
    for (let at = distance; at < 2 * half[axis]; at += distance) {
      const foot = half.map((h) => -h);
      foot[axis] += at;
      const tip = foot.slice();
      tip[u] -= kTickLength;
      ends.push(...foot, ...tip);
    }
  }
  return ends;
}

export class BoxFrame {
  // half: half sides, page units; unit: mesh units per page unit.
  constructor(half, unit) {
    this.tickDistance = roundLength((4 * unit * Math.max(...half)) / kMostTicks); // mesh units
    const ends = [...boxEdges(half), ...ticks(half, this.tickDistance / unit)];
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(ends), 3));
    this.object = new LineSegments(geometry, new LineBasicMaterial({ transparent: true, opacity: 0.28 }));
    this.object.renderOrder = 5;
  }

  paint(theme) {
    this.object.material.color.set(theme.ink);
  }
}
