// The controls of the clipping plane.
import { rounded } from './numbers.js';

/** @type {(id: string) => any} */
const element = (id) => document.getElementById(id);

const kAxes = ['x', 'y', 'z'];
const kAside = 0.3; // an axis within 17 degrees of the picture's plane is seen from aside
const kInSight = 0.75; // of the skeleton

/** Axis, place and side of the plane, as the user sets them. */
export class Clipping {
  /**
   * half(axis): half of the longest box along it, page units; toward(axis): a component of the direction to the
   * viewer; skeletons(): their places; coordinate(axis, at): in mesh units; changed(): the scene.
   * @param {import('./clip.js').Clip} clip
   * @param {{ half: (axis: number) => number, toward: (axis: number) => number, skeletons: () => Float32Array[],
   *   coordinate: (axis: number, at: number) => number, changed: () => void }} scene
   */
  constructor(clip, scene) {
    this.clip = clip;
    this.scene = scene;
    element('clip-place').addEventListener('input', () => this.apply());
    element('clip-axis').addEventListener('change', () => this.begin());
    element('clip-flip').addEventListener('change', () => this.apply());
  }

  // Opens the body towards the viewer, with most of the skeleton in sight; from aside in the middle.
  begin() {
    const axis = kAxes.indexOf(element('clip-axis').value);
    const toward = axis < 0 ? 0 : this.scene.toward(axis);
    const side = toward < -kAside ? -1 : 1;
    const half = axis < 0 ? 0 : this.scene.half(axis);
    element('clip-flip').checked = side < 0;
    element('clip-place').value = Math.abs(toward) > kAside && half > 0 ? (side * this.nearMost(axis, side)) / half : 0;
    this.apply();
  }

  // On which side of an axis (1 or -1), and how far, three quarters of the skeletons lie below.
  nearMost(axis, side) {
    const all = this.scene.skeletons().flatMap((places) => Array.from(places).filter((_, i) => i % 3 === axis));
    all.sort((a, b) => side * (a - b));
    return all.length ? side * all[Math.floor(kInSight * (all.length - 1))] : 0;
  }

  // The place goes from one end of the largest box to the other.
  plane() {
    const axis = kAxes.indexOf(element('clip-axis').value);
    const half = axis < 0 ? 0 : this.scene.half(axis);
    return { axis, at: element('clip-place').valueAsNumber * half, beyond: element('clip-flip').checked ? -1 : 1 };
  }

  apply() {
    const { axis, at, beyond } = this.plane();
    this.clip.set(axis, at, beyond);
    for (const id of ['clip-place', 'clip-flip']) element(id).disabled = axis < 0;
    element('clip-value').textContent =
      axis < 0 ? '' : `${'xyz'[axis]} ${beyond > 0 ? '≤' : '≥'} ${rounded(this.scene.coordinate(axis, at), 4)}`;
    this.scene.changed();
  }

  // at: from -1 to 1, the share of the box.
  set({ axis, beyond, at }) {
    element('clip-axis').value = axis;
    element('clip-flip').checked = beyond === '>';
    element('clip-place').value = at;
    this.apply();
  }

  // As a link keeps it.
  text() {
    const { axis } = this.plane();
    if (axis < 0) return '';
    return `${'xyz'[axis]}${element('clip-flip').checked ? '>' : '<'}${element('clip-place').value}`;
  }
}
