// The address of what is seen: camera, sliders and layers in the fragment of the page's address.
const kZooms = [1e-3, 1e3]; // what anybody looks at
const kFarthest = 1e3; // in heights of the body
const kDelay = 200; // milliseconds after the last change: browsers refuse hundreds of changes at once

const number = (text) => (text !== null && text.trim() !== '' && Number.isFinite(Number(text)) ? Number(text) : null);
/** @type {(text: string | null, count: number) => number[] | null} */
const numbers = (text, count) => {
  const parts = (text || '').split(',').map(number);
  return parts.length === count && parts.every((part) => part !== null) ? /** @type {number[]} */ (parts) : null;
};
const short = (value) => String(Number(value.toPrecision(6)));

/**
 * State as text, without the #.
 * @param {Seen} state
 * @returns {string}
 */
export function writeLink(state) {
  const link = new URLSearchParams();
  if (state.view) link.set('view', state.view);
  else {
    link.set('camera', [state.azimuth, state.elevation, state.zoom].map(short).join(','));
    if (state.target.some((c) => Math.abs(c) > 1e-6)) link.set('at', state.target.map(short).join(','));
  }
  link.set('threshold', state.thresholds.map(short).join(','));
  link.set('level', short(state.level));
  link.set('show', state.shown.join(','));
  if (state.opacity !== null) link.set('opacity', short(state.opacity));
  if (state.body) link.set('body', state.body);
  if (state.clip) link.set('clip', state.clip);
  return link.toString().replace(/%2C/g, ',');
}

/**
 * What of a state the text says; anything else in it is passed over.
 * @param {string} text
 * @returns {LinkState}
 */
export function readLink(text) {
  const link = new URLSearchParams(text.replace(/^#/, ''));
  /** @type {LinkState} */
  const state = {};
  const camera = numbers(link.get('camera'), 3);
  const view = link.get('view');
  if (view && ['front', 'side', 'top', 'start'].includes(view)) state.view = view;
  else if (camera && Math.abs(camera[1]) <= 90 && camera[2] >= kZooms[0] && camera[2] <= kZooms[1]) {
    [state.azimuth, state.elevation, state.zoom] = camera;
    const target = numbers(link.get('at'), 3);
    state.target = target && target.every((c) => Math.abs(c) <= kFarthest) ? target : [0, 0, 0];
  }
  const thresholds = numbers(link.get('threshold'), (link.get('threshold') || '').split(',').length);
  if (thresholds) state.thresholds = thresholds;
  const level = number(link.get('level'));
  if (level !== null) state.level = level;
  const shown = link.get('show');
  if (shown !== null) state.shown = shown.split(',');
  const opacity = number(link.get('opacity'));
  if (opacity !== null) state.opacity = opacity;
  const body = link.get('body');
  if (body === 'part' || body === 'thickness') state.body = body;
  const clip = /^([xyz])([<>])(-?[0-9.e-]+)$/.exec(link.get('clip') || '');
  const at = clip && number(clip[3]);
  if (clip && at !== null) state.clip = { axis: clip[1], beyond: clip[2], at };
  return state;
}

/** Keeps the address at what is seen. */
export class Link {
  // state(): the text of what is seen now; changed(text): the user has opened another.
  constructor(state, changed) {
    this.state = state;
    window.addEventListener('hashchange', () => changed(window.location.hash));
  }

  // Soon puts what is seen into the address.
  update() {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      const text = this.state();
      // What shows this page in a frame can show another one from the same place.
      if (window.parent !== window) window.parent.postMessage({ affskelLink: text }, '*');
      try {
        window.history.replaceState(null, '', `#${text}`);
      } catch (error) {
        if (/** @type {Error} */ (error).name !== 'SecurityError') throw error; // a frame of a notebook has no address of its own
      }
    }, kDelay);
  }
}
