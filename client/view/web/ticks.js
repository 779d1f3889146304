// The numbers at the ticks of the box: text over the canvas, so that it is sharp and no smaller on a phone.
import { Vector3 } from 'three';
import { coordinate } from './numbers.js';

const kGap = 4; // pixels between a tick and its number
const kMinGap = 6; // pixels between two numbers
const kMultiples = [1, 2, 5, 10, 20, 50, 100];

const overlap = (a, b) =>
  Math.abs(a.x - b.x) < (a.width + b.width) / 2 + kMinGap / 2 &&
  Math.abs(a.y - b.y) < (a.height + b.height) / 2;

/** One number for each tick, hidden where it has no room. */
export class TickNumbers {
  constructor(container, box) {
    this.container = container;
    this.box = box;
    this.spans = box.ticks.map((ticks, axis) =>
      ticks.map(({ coordinate: value }) => {
        const span = container.ownerDocument.createElement('span');
        span.className = 'xyz'[axis];
        span.textContent = coordinate(value);
        container.append(span);
        return span;
      }),
    );
  }

  // The sizes of all numbers, pixels; needs a layout.
  measure() {
    if (this.sizes) return;
    this.sizes = this.spans.map((spans) =>
      spans.map((span) => ({ width: span.offsetWidth, height: span.offsetHeight })),
    );
  }

  widest() {
    this.measure();
    return Math.max(0, ...this.sizes.flat().map((size) => size.width));
  }

  /**
   * pixels: of the layout, per page unit.
   * @param {import('three').Camera} camera
   * @param {number} pixels
   */
  place(camera, pixels) {
    this.measure();
    const placed = [];
    this.box.edges.forEach((edge, axis) => {
      const labels = edge ? this.labelsOf(edge, axis, camera) : [];
      const every = edge ? this.labelInterval(edge, axis, pixels) : 1;
      this.spans[axis].forEach((span, i) => {
        const label = labels[i];
        const shown =
          edge && this.box.ticks[axis][i].index % every === 0 && !placed.some((p) => overlap(p, label));
        span.hidden = !shown;
        if (!shown) return;
        placed.push(label);
        span.style.transform =
          `translate(${(label.x - label.width / 2).toFixed(1)}px, ${(label.y - label.height / 2).toFixed(1)}px)`;
      });
    });
  }

  /**
   * Middles and sizes, pixels from the upper left corner of the canvas.
   * @param {import('three').Camera} camera
   */
  labelsOf(edge, axis, camera) {
    const { clientWidth, clientHeight } = this.container;
    const [right, up] = edge.outward;
    return this.box.ticks[axis].map(({ at }, i) => {
      const foot = this.box.placeOn(edge, axis, at);
      const tip = new Vector3(...foot.map((c, k) => c + edge.tick[k])).project(camera);
      const { width, height } = this.sizes[axis][i];
      const away = kGap + (Math.abs(right) * width) / 2 + (Math.abs(up) * height) / 2;
      return {
        x: ((tip.x + 1) / 2) * clientWidth + away * right,
        y: ((1 - tip.y) / 2) * clientHeight - away * up,
        width,
        height,
      };
    });
  }

  /**
   * Every how many ticks there is a number, so that there is room for the longest.
   * @param {number} pixels
   */
  labelInterval(edge, axis, pixels) {
    const width = Math.max(0, ...this.sizes[axis].map((size) => size.width));
    const height = Math.max(0, ...this.sizes[axis].map((size) => size.height));
    const [right, up] = edge.outward;
    // Along the edge: across `outward`.
    const needed = Math.min(width / Math.max(1e-6, Math.abs(up)), height / Math.max(1e-6, Math.abs(right)));
    const distance = (this.box.tickDistance / this.box.unit) * pixels * edge.length;
    return kMultiples.find((multiple) => multiple * distance >= needed + kMinGap) || kMultiples[kMultiples.length - 1];
  }
}
