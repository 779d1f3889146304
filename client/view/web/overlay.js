// What lies over the canvas: the cross of axes, the scale bar, the legend.
import { Vector3 } from 'three';
import { gradient, shareAt } from './colours.js';
import { rounded, roundLength } from './numbers.js';

const kCrossRadius = 23; // of the 72 wide drawing
const kLetterGap = 8;
const kTicks = [0, 0.25, 0.5, 0.75, 1];

export function drawCross(svg, camera) {
  camera.updateMatrixWorld();
  for (const [axis, direction] of [
    ['x', [1, 0, 0]],
    ['y', [0, 1, 0]],
    ['z', [0, 0, 1]],
  ]) {
    const at = new Vector3(...direction).transformDirection(camera.matrixWorldInverse);
    const line = svg.querySelector(`line.${axis}`);
    const label = svg.querySelector(`text.${axis}`);
    line.setAttribute('x2', kCrossRadius * at.x);
    line.setAttribute('y2', -kCrossRadius * at.y);
    const length = Math.hypot(at.x, at.y);
    const reach = kCrossRadius + kLetterGap / Math.max(length, 0.2);
    label.setAttribute('x', reach * at.x);
    label.setAttribute('y', -reach * at.y);
    // An axis that points at the viewer has no place for its letter.
    label.style.opacity = length < 0.2 ? 0 : 1;
  }
}

// unitPixels: screen pixels per mesh unit.
export function drawScaleBar(element, unitPixels, room) {
  const length = roundLength(Math.max(60, Math.min(180, 0.3 * room)) / unitPixels);
  element.querySelector('.bar').style.width = `${length * unitPixels}px`;
  const text = `${rounded(length, 6)} ${length === 1 ? 'unit' : 'units'}`;
  const label = element.querySelector('.length');
  if (label.textContent !== text) label.textContent = text;
}

export function paintLegend(element, lift) {
  element.querySelector('.colours').style.background = gradient(lift);
}

// Labels in per cent of v0, at equal distances of the cube root, as the colours are.
export function labelLegend(element, highest) {
  const numbers = element.querySelector('.numbers');
  for (const tick of kTicks) {
    const label = numbers.ownerDocument.createElement('span');
    label.textContent = tick === 0 ? '0' : rounded(100 * shareAt(tick, highest), 2);
    numbers.append(label);
  }
}
