// Values under the pointer: on hover with a mouse, on a tap with a finger.
import { coordinate, rounded } from './numbers.js';

const kTap = 8; // pixels that a finger may move
const kGap = 14; // pixels from the pointer

// What is known of a place, of what may be.
const known = (name, value) => (value === null || value === undefined ? [] : [[name, rounded(value, 4)]]);
const vector = (v, digits) => `(${v.map((c) => coordinate(Number(c.toPrecision(digits)))).join(', ')})`;

const erosionValues = (share, volume) => [
  ['E', `${rounded(share * volume, 4)}`],
  ['share of v0', `${rounded(100 * share, 4)} %`],
];

const partValues = ({ share, length, radius }) => [
  ['volume', `${rounded(100 * share, 3)} %`],
  ['length', rounded(length, 4)],
  ['mean radius', rounded(radius, 4)],
];

/**
 * Name and text of all that is known of a place: see Model.at.
 * @param {ProbedModel} model
 * @param {Found} found
 * @returns {string[][]}
 */
export function valuesOf(model, found) {
  const { volume } = model.facts;
  const values = found.part ? partValues(found.part) : erosionValues(found.share, volume);
  values.push(...known('slope |∇E|', found.slope));
  values.push(...known('strength', found.strength));
  values.push(...known('thickness here', found.thickness));
  values.push(...known('|H|', found.divergence));
  values.push(['place', vector(model.coordinates(found.place), 6)]);
  found.directions.forEach((d, i) => {
    const name = found.directions.length > 1 ? `direction, side ${i + 1}` : 'direction';
    values.push([name, vector(d.map((c) => Number(c.toFixed(2))), 3)]);
  });
  return values;
}

/** Shows them in a box beside the pointer. */
export class Probe {
  /**
   * box: the element to fill; canvas; find(x, y): what lies there, pixels of the canvas: null, or model and
   * found.
   * @param {HTMLCanvasElement} canvas
   */
  constructor(box, canvas, find) {
    this.box = box;
    this.canvas = canvas;
    this.find = find;
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerleave', (event) => event.pointerType === 'mouse' && this.hide());
    canvas.addEventListener('pointerdown', (event) => this.press(event));
    canvas.addEventListener('pointerup', (event) => this.release(event));
    canvas.addEventListener('wheel', () => this.hide());
  }

  move(event) {
    if (event.pointerType !== 'mouse' || event.buttons) return;
    this.at = event;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.at) this.show(this.at.clientX, this.at.clientY);
    });
  }

  press(event) {
    this.pressed = event.isPrimary ? event : null;
    this.hide();
  }

  release(event) {
    const from = this.pressed;
    this.pressed = null;
    if (!from || Math.hypot(event.clientX - from.clientX, event.clientY - from.clientY) > kTap) return;
    this.show(event.clientX, event.clientY);
  }

  hide() {
    this.at = null;
    this.box.hidden = true;
  }

  // x, y: pixels of the window.
  show(x, y) {
    const room = this.canvas.getBoundingClientRect();
    const result = this.find(x - room.left, y - room.top);
    this.box.hidden = !result;
    if (!result) return;
    const element = (name, textContent) => Object.assign(document.createElement(name), { textContent });
    const values = valuesOf(result.model, result.found);
    const list = document.createElement('dl');
    for (const [name, text] of values) list.append(element('dt', name), element('dd', text));
    this.box.replaceChildren(element('strong', result.found.what), list);
    const { offsetWidth: width, offsetHeight: height } = this.box;
    const beside = x - room.left + kGap + width > room.width ? x - room.left - kGap - width : x - room.left + kGap;
    const below = y - room.top + kGap + height > room.height ? y - room.top - kGap - height : y - room.top + kGap;
    this.box.style.left = `${Math.max(4, Math.min(beside, room.width - width - 4))}px`;
    this.box.style.top = `${Math.max(4, Math.min(below, room.height - height - 4))}px`;
  }
}
