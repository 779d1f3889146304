// The page: reads its data, builds the scene, wires the controls.
import { Color } from 'three';
import { widened } from './cell.js';
import { themeColours } from './colours.js';
import { SkinCloud } from './clouds.js';
import { decodePage, meshPositions, pointPositions } from './decode.js';
import { TickedBox } from './ticked_box.js';
import { Glass } from './glass.js';
import { rounded, whole } from './numbers.js';
import { drawCross, drawScaleBar, labelLegend, paintLegend } from './overlay.js';
import { makeErosion, makeSkeleton } from './skeleton.js';
import { minAround, sublattice } from './neighbours.js';
import { Slider } from './slider.js';
import { Stage } from './stage.js';
import { TickNumbers } from './ticks.js';

const kBottomInset = 22; // pixels below the box: a tick and a line of numbers
const kSideInset = 16; // pixels beside the box, and the widest number: a tick and gaps

const element = (id) => document.getElementById(id);

function fail(message) {
  const box = element('failure');
  box.textContent = message;
  box.hidden = false;
  document.body.classList.add('failed');
}

// Pixels that the view keeps free: for the buttons above, the legend below, the numbers round the box.
function freeEdges(numbers) {
  const [main, nav, foot] = ['main', 'nav', '.foot'].map((s) =>
    document.querySelector(s).getBoundingClientRect(),
  );
  return {
    top: nav.bottom - main.top,
    bottom: main.bottom - foot.top + kBottomInset,
    side: Math.min(numbers.widest() + kSideInset, main.width / 4),
  };
}

class Viewer {
  constructor(page) {
    this.page = page;
    const positions = pointPositions(page);
    this.skeleton = makeSkeleton(page, positions);
    this.erosion = makeErosion(page);
    this.skin = new SkinCloud(positions, {
      inward: page.arrays.pointInward,
      order: this.erosion.order,
      cell: widened(page.cell, page.thinning),
      around: minAround(
        page.arrays.pointSteps,
        page.arrays.pointShares,
        sublattice(page.thinning).neighbours,
      ),
    });
    this.glass = new Glass(meshPositions(page), page.arrays.meshCorners);
    this.box = new TickedBox(page.halfBox, page.centre, page.unit);
    this.numbers = new TickNumbers(element('tick-numbers'), this.box);
    this.stage = new Stage(element('canvas'), {
      up: page.up,
      halfBox: page.halfBox,
      inset: () => freeEdges(this.numbers),
      beforeDraw: () => this.beforeDraw(),
    });
    this.layers = {
      mesh: this.glass.object,
      skeleton: this.skeleton.drawn.object,
      eroded: this.skin.object,
      axes: this.box.object,
    };
    this.stage.scene.add(...Object.values(this.layers));
    this.shown = { skeleton: 0, eroded: 0 };
    this.showFacts();
    this.wireSliders();
    this.wireToggles();
    this.wireButtons();
    this.setTheme(window.matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark');
  }

  beforeDraw() {
    const pixels = this.stage.pixelsPerUnit();
    const buffer = pixels * this.stage.renderer.getPixelRatio();
    this.stage.camera.updateMatrixWorld();
    this.skeleton.drawn.look(this.stage.camera, buffer);
    this.skin.look(this.stage.camera, buffer);
    this.box.look(this.stage.camera);
    this.numbers.place(this.stage.camera, pixels);
    drawCross(element('cross'), this.stage.camera);
    drawScaleBar(element('scale'), pixels / this.page.unit, this.stage.canvas.clientWidth);
  }

  showFacts() {
    const { page } = this;
    const facts = {
      triangles: whole(page.triangles),
      'sample points': whole(page.points),
      spacing: rounded(page.spacing, 5),
      directions: whole(page.directions),
      operator: page.operator,
      frame: page.frame,
      v0: rounded(page.volume),
      box: page.box.map((side) => rounded(side, 4)).join(' × '),
      job: page.job.slice(0, 12),
    };
    for (const [name, value] of Object.entries(facts)) {
      element('facts-list').append(
        Object.assign(document.createElement('dt'), { textContent: name }),
        Object.assign(document.createElement('dd'), { textContent: value }),
      );
    }
    element('ticks').textContent =
      `Numbers on the box are coordinates, its ticks ${rounded(this.box.tickDistance, 6)} units apart.`;
    if (page.thinning > 1) {
      element('thinned').hidden = false;
      element('thinned').textContent =
        `This page holds ${whole(page.pointsHere)} of the ${whole(page.points)} sample points: every one ` +
        `that the threshold slider can show, and for the eroded solid one in ${whole(page.thinning)}.`;
    }
    labelLegend(element('legend'), page.highestShare);
  }

  wireSliders() {
    const { page, skeleton } = this;
    element('threshold-name').textContent = skeleton.name;
    element('threshold-symbol').textContent = skeleton.symbol;
    element('threshold-field').setAttribute('aria-label', skeleton.name);
    this.threshold = new Slider(element('threshold'), {
      low: skeleton.low,
      high: skeleton.high,
      curve: skeleton.curve,
      changed: () => this.applyThreshold(),
    });
    this.level = new Slider(element('level'), {
      low: 0,
      high: 100 * page.highestShare,
      curve: 3,
      changed: () => {
        this.toggle('eroded', true);
        this.applyLevel();
      },
    });
    this.resetSliders();
  }

  resetSliders() {
    this.threshold.set(this.skeleton.first);
    this.level.set(Number((10 * this.page.highestShare).toPrecision(2)));
    this.applyThreshold();
    this.applyLevel();
  }

  applyThreshold() {
    const { skeleton, threshold } = this;
    this.shown.skeleton = skeleton.show(threshold.value);
    element('threshold-count').textContent = skeleton.describe(this.shown.skeleton, threshold.value);
    this.stage.requestDraw();
  }

  applyLevel() {
    const { page } = this;
    this.shown.eroded = this.erosion.count(this.share());
    this.skin.show(this.shown.eroded, this.share());
    const points = `${whole(this.shown.eroded)} points${page.thinning > 1 ? ' drawn' : ''}`;
    const volume = rounded((100 * this.shown.eroded) / this.erosion.total, 3);
    element('level-count').textContent = `${points}, about ${volume} % of the volume`;
    this.stage.requestDraw();
  }

  // The erosion level as a share of v0.
  share() {
    return this.level.value / 100;
  }

  toggle(name, on) {
    element(`show-${name}`).checked = on;
    if (this.layers[name]) this.layers[name].visible = on;
    if (name === 'axes') {
      for (const id of ['cross', 'tick-numbers']) element(id).classList.toggle('off', !on);
    }
    if (name === 'scale') element('scale').classList.toggle('off', !on);
    this.glass.fade(element('show-eroded').checked ? 0.45 : 1);
    this.stage.requestDraw();
  }

  wireToggles() {
    for (const name of ['mesh', 'skeleton', 'eroded', 'axes', 'scale']) {
      const box = element(`show-${name}`);
      box.addEventListener('change', () => this.toggle(name, box.checked));
      this.toggle(name, box.checked);
    }
  }

  wireButtons() {
    for (const view of ['front', 'side', 'top']) {
      element(`view-${view}`).addEventListener('click', () => this.stage.show(view));
    }
    element('reset').addEventListener('click', () => this.reset());
    element('theme').addEventListener('click', () => this.setTheme(this.theme === 'dark' ? 'light' : 'dark'));
    element('fold').addEventListener('click', () => {
      const open = document.body.classList.toggle('open');
      element('fold').setAttribute('aria-expanded', open);
    });
    document.addEventListener('keydown', (event) => {
      const view = { 1: 'front', 2: 'side', 3: 'top' }[event.key];
      if (event.target.matches('input') || event.ctrlKey || event.metaKey || event.altKey) return;
      if (view) this.stage.show(view);
      if (event.key === '0') this.reset();
    });
  }

  reset() {
    for (const name of ['mesh', 'skeleton', 'axes', 'scale']) this.toggle(name, true);
    this.toggle('eroded', false);
    this.resetSliders();
    this.stage.show('start');
  }

  setTheme(name) {
    this.theme = name;
    document.documentElement.dataset.theme = name;
    const colours = themeColours(name);
    this.stage.renderer.setClearColor(new Color(colours.background));
    for (const layer of [this.glass, this.skeleton.drawn, this.skin, this.box]) layer.paint(colours);
    paintLegend(element('legend'), colours.lift);
    element('theme').textContent = name === 'dark' ? 'Light background' : 'Dark background';
    this.stage.requestDraw();
  }

  // For tests.
  state() {
    const { camera, controls } = this.stage;
    return {
      operator: this.page.operator,
      threshold: this.threshold.value,
      level: this.share(),
      skeletonShown: this.shown.skeleton,
      erodedShown: this.shown.eroded,
      pointsHere: this.page.pointsHere,
      thinning: this.page.thinning,
      camera: { position: camera.position.toArray(), target: controls.target.toArray(), zoom: camera.zoom },
      visible: Object.fromEntries(Object.entries(this.layers).map(([name, layer]) => [name, layer.visible])),
      theme: this.theme,
    };
  }

  // Mean milliseconds to draw the scene, over `frames` drawings, each waited for.
  frameTime(frames) {
    const gl = this.stage.renderer.getContext();
    const pixel = new Uint8Array(4);
    const start = performance.now();
    for (let f = 0; f < frames; ++f) {
      this.stage.orbit(0.05, 0);
      this.stage.draw();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    }
    return (performance.now() - start) / frames;
  }
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
  window.affskel = { state: () => viewer.state(), frameTime: (frames) => viewer.frameTime(frames) };
}

start();
