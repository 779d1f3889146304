// What lies over the canvas: the cross of axes, the scale bar, the legend.
import { Vector3 } from 'three';
import { gradient, shareAt } from './colours.js';
import { rounded, roundLength } from './numbers.js';

const kCrossRadius = 23; // in a drawing 72 wide
const kLetterGap = 8;
const kLetterWidth = 10;
const kMinLength = 0.2; // of an axis seen on the screen, as a share of itself: shorter ones get no letter
const kTicks = [0, 0.25, 0.5, 0.75, 1];

/** @type {(whole: Element, selector: string) => any} */
const partOf = (whole, selector) => whole.querySelector(selector);

/**
 * Turns the cross of axes as the camera is turned.
 * @param {Element} svg
 * @param {import("three").Camera} camera
 */
export function drawCross(svg, camera) {
  const axes = Object.entries({ x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }).map(([name, direction]) => {
    const at = new Vector3(...direction).transformDirection(camera.matrixWorldInverse);
    const length = Math.hypot(at.x, at.y);
    const reach = kCrossRadius + kLetterGap / Math.max(length, kMinLength);
    return {
      name,
      length,
      end: [kCrossRadius * at.x, -kCrossRadius * at.y],
      letter: [reach * at.x, -reach * at.y],
    };
  });
  axes.sort((a, b) => b.length - a.length);
  axes.forEach(({ name, length, end, letter }, place) => {
    const line = partOf(svg, `line.${name}`);
    const label = partOf(svg, `text.${name}`);
    ['x2', 'y2'].forEach((attribute, c) => line.setAttribute(attribute, end[c]));
    ['x', 'y'].forEach((attribute, c) => label.setAttribute(attribute, letter[c]));
    // No letter for an axis that points at the viewer, nor where it would cover the letter of a longer axis.
    const near = (other) =>
      Math.hypot(letter[0] - other.letter[0], letter[1] - other.letter[1]) < kLetterWidth;
    label.style.opacity = length < kMinLength || axes.slice(0, place).some(near) ? 0 : 1;
  });
}

/**
 * Draws a bar of a round length.
 * @param {Element} element
 * @param {number} unitPixels screen pixels per mesh unit
 * @param {number} room pixels
 */
export function drawScaleBar(element, unitPixels, room) {
  const length = roundLength(Math.max(60, Math.min(180, 0.3 * room)) / unitPixels);
  partOf(element, '.bar').style.width = `${length * unitPixels}px`;
  const text = `${rounded(length, 6)} ${length === 1 ? 'unit' : 'units'}`;
  const label = partOf(element, '.length');
  if (label.textContent !== text) label.textContent = text;
}

/**
 * Gives the legend the theme's colours.
 * @param {Element} element
 * @param {number} lift
 */
export function paintLegend(element, lift) {
  partOf(element, '.colours').style.background = gradient(lift);
}

/**
 * valueAt: of a place on the scale, 0 .. 1; isPassed: the last colour stands for more, too.
 * @param {Element} element
 * @param {{ title: string, note: string, valueAt: (tick: number) => number, isPassed?: boolean }} scale
 */
export function labelLegend(element, { title, note, valueAt, isPassed = false }) {
  partOf(element, '.heading').textContent = title;
  partOf(element, '.note').textContent = note;
  const numbers = partOf(element, '.numbers');
  numbers.replaceChildren(
    ...kTicks.map((tick) =>
      Object.assign(numbers.ownerDocument.createElement('span'), {
        textContent: tick === 0 ? '0' : rounded(valueAt(tick), 2) + (tick === 1 && isPassed ? '+' : ''),
      }),
    ),
  );
}

/**
 * Labels in per cent of v0, at equal distances of the cube root, as the colours are.
 * @param {{ highestShare: number, scaleTitle: string, scaleNote: string }} page
 */
export const erosionScale = ({ highestShare, scaleTitle, scaleNote }) => ({
  title: scaleTitle,
  note: scaleNote,
  valueAt: (tick) => 100 * shareAt(tick, highestShare),
});

/**
 * Of the body's thickness, evenly.
 * @param {{ highest: number, greatest: number }} thickness see thickness_scale() in client/artifacts/solid_parts.h
 */
export const thicknessScale = ({ highest, greatest }) => ({
  title: 'Thickness, mesh units',
  note: 'From the surface to the skeleton',
  valueAt: (tick) => tick * highest,
  isPassed: greatest > highest,
});
