// The page: reads its data, builds the scene, wires the controls.
import { decodePage } from './decode.js';
import { Viewer } from './viewer.js';

/** @type {(id: string) => any} */
const element = (id) => document.getElementById(id);

/** @param {string} message */
function fail(message) {
  const box = element('failure');
  box.textContent = message;
  box.hidden = false;
  document.body.classList.add('failed');
}

function start() {
  const probe = document.createElement('canvas');
  if (!probe.getContext('webgl')) {
    fail(
      'This page draws with WebGL, which this browser does not offer. Enable hardware acceleration or ' +
        'WebGL in its settings, or open the page in another browser.',
    );
    return;
  }
  element('canvas').addEventListener('webglcontextlost', () =>
    fail('The graphics driver gave up. Reload the page.'),
  );
  const viewer = new Viewer(decodePage(document));
  window.affskel = {
    state: () => viewer.state(),
    frameTime: (frames) => viewer.frameTime(frames),
    picture: () => viewer.picture().toDataURL(),
    valuesAt: (x, y) => viewer.valuesAt(x, y),
  };
}

start();
