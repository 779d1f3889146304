// The controls of the clipping plane.
import { rounded } from './numbers.js';

/** @type {(id: string) => any} */
const element = (id) => document.getElementById(id);

/** Axis, place and side of the plane, as the user sets them. */
export class Clipping {
  /**
   * half(axis): half of the longest box along it, page units; coordinate(axis, at): in mesh units; changed(): the
   * scene.
   * @param {import('./clip.js').Clip} clip
   * @param {{ half: (axis: number) => number, coordinate: (axis: number, at: number) => number,
   *   changed: () => void }} scene
   */
  constructor(clip, scene) {
    this.clip = clip;
    this.scene = scene;
    element('clip-place').addEventListener('input', () => this.apply());
    for (const id of ['clip-axis', 'clip-flip']) element(id).addEventListener('change', () => this.apply());
  }

  // The place goes from one end of the largest box to the other.
  plane() {
    const axis = ['x', 'y', 'z'].indexOf(element('clip-axis').value);
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
