// The camera and the loop that draws: orthographic, so that lengths on the screen are lengths of the body.  Two
// models have a pane each and one camera.
import { Box3, OrthographicCamera, Quaternion, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'orbit-controls';

const kDistance = 12; // of the camera: further away than any panning moves the body
const kDepth = 6; // how far before and behind the middle things are drawn
const kMargin = 1.06;
const kMaxPixelRatio = 2; // more costs time and cannot be seen
const kOrbitStep = Math.PI / 18;
const kFrame = 50; // milliseconds that a frame may take while the body turns
const kLeastResolution = 0.4; // share of the pixels along either side
const kMostThinned = 16; // so many points for one that is drawn
const kRadians = Math.PI / 180;
const kPole = 90 - 1e-3; // degrees: at the pole itself "right" is undefined

// Azimuth and elevation, degrees, as in pictures (client/render/camera.h).
const kViews = { front: [0, 0], side: [90, 0], top: [0, 90], start: [27, 13] };

/** Camera, panes and what draws them. */
export class Stage {
  // stance: unit vectors right, up and front of a body.  halfBox: half the sides, about the origin, of a box
  // that holds all models.  panes: how many.  inset(): pixels of a pane to keep free at the top, at the bottom
  // and on either side when the whole body is shown.  room(): pixels above and below panes that lie upon each
  // other.  beforeDraw runs before every drawing, changed after every turn; thin(every) draws one point of so many
  // from then on.
  constructor(canvas, { stance, halfBox, panes, inset, room, beforeDraw, changed, thin }) {
    this.canvas = canvas;
    this.inset = inset;
    this.room = room;
    this.beforeDraw = beforeDraw;
    this.changed = changed;
    this.thin = thin;
    this.right = new Vector3(...stance.right);
    this.up = new Vector3(...stance.up);
    this.front = new Vector3(...stance.front);
    this.halfBox = new Vector3(...halfBox);
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.autoClear = false;
    this.scenes = Array.from({ length: panes }, () => new Scene());
    this.camera = new OrthographicCamera(-1, 1, 1, -1, kDistance - kDepth, kDistance + kDepth);
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableKeys = false; // see pressKey
    this.controls.screenSpacePanning = true;
    this.controls.minZoom = 0.1;
    this.controls.maxZoom = 500;
    this.controls.addEventListener('change', () => this.requestDraw());
    this.controls.addEventListener('start', () => this.turn());
    this.controls.addEventListener('end', () => this.ease(1, 1));
    this.resolution = 1; // share of the pixels along either side
    this.every = 1; // see thin
    this.changes = 0; // of what is shown
    canvas.addEventListener('wheel', () => (this.view = ''));
    canvas.addEventListener('keydown', (event) => this.pressKey(event));
    // A new size clears the canvas: draw at once, before it is seen black.
    new ResizeObserver(() => {
      if (this.resize()) this.draw();
    }).observe(canvas.parentElement);
    this.resize();
    this.show('start');
  }

  // The panes: left, top, width and height, pixels from the upper left corner of the canvas.
  panes() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const count = this.scenes.length;
    if (count === 1) return [{ left: 0, top: 0, width, height }];
    if (width >= height) {
      return this.scenes.map((_, i) => ({ left: (i * width) / count, top: 0, width: width / count, height }));
    }
    const { above, below } = this.room();
    const each = Math.max(height / 3, height - above - below) / count;
    return this.scenes.map((_, i) => ({ left: 0, top: above + i * each, width, height: each }));
  }

  // One of front, side, top, start: the whole body in the window.
  show(view) {
    this.look(...kViews[view], [0, 0, 0], 1);
    this.view = view;
  }

  // azimuth, elevation: degrees; target: shown in the middle, page units; zoom: 1 shows the whole body.
  look(azimuth, elevation, target, zoom) {
    this.view = '';
    const [a, e] = [azimuth * kRadians, Math.max(-kPole, Math.min(kPole, elevation)) * kRadians];
    const from = this.front.clone().multiplyScalar(Math.cos(a) * Math.cos(e));
    from.addScaledVector(this.right, Math.sin(a) * Math.cos(e)).addScaledVector(this.up, Math.sin(e));
    this.controls.target.set(...target);
    this.camera.position.copy(this.controls.target).addScaledVector(from, kDistance);
    this.controls.update();
    this.camera.zoom = zoom * this.wholeZoom();
    this.frame();
    this.requestDraw();
  }

  // What look() takes.
  looking() {
    const offset = this.camera.position.clone().sub(this.controls.target).normalize();
    const elevation = Math.asin(Math.max(-1, Math.min(1, offset.dot(this.up)))) / kRadians;
    const azimuth = Math.atan2(offset.dot(this.right), offset.dot(this.front)) / kRadians;
    const target = this.controls.target.toArray();
    return { view: this.view, azimuth, elevation, target, zoom: this.camera.zoom / this.wholeZoom() };
  }

  // Where the viewer is: a component of the direction to him.
  toward(axis) {
    return this.camera.position.clone().sub(this.controls.target).normalize().getComponent(axis);
  }

  // The zoom at which the whole body is in a pane.
  wholeZoom() {
    this.camera.updateMatrixWorld();
    const box = new Box3(this.halfBox.clone().negate(), this.halfBox.clone());
    const turn = this.camera.matrixWorldInverse.clone().setPosition(0, 0, 0);
    box.applyMatrix4(turn);
    const [{ width, height }] = this.panes();
    const full = this.canvas.clientHeight;
    const { top, bottom, side } = this.inset();
    const room = Math.max(height / 3, height - top - bottom);
    return Math.min((width - 2 * side) / full / box.max.x, room / full / box.max.y) / kMargin;
  }

  // A pane shows the middle of what the whole canvas would.
  frame() {
    const { clientWidth, clientHeight } = this.canvas;
    const [{ width, height }] = this.panes();
    const { top, bottom } = this.inset();
    const [x, y] = [(clientWidth - width) / 2, (clientHeight - height) / 2 + (bottom - top) / 2];
    this.camera.right = clientWidth / clientHeight;
    this.camera.left = -this.camera.right;
    this.camera.setViewOffset(clientWidth, clientHeight, x, y, width, height); // updates the projection
  }

  // Fits the canvas to its parent element; false when that has no size.
  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    if (clientWidth === 0 || clientHeight === 0) return false;
    this.renderer.setPixelRatio(this.pixelRatio());
    this.renderer.setSize(clientWidth, clientHeight);
    this.frame();
    if (this.view) this.show(this.view); // still as chosen: keep it in the window
    else this.requestDraw();
    return true;
  }

  // Pixels of the drawing buffer per pixel of the layout.
  pixelRatio() {
    return this.resolution * Math.min(window.devicePixelRatio || 1, kMaxPixelRatio);
  }

  // The user begins to turn the body: with fewer pixels where the scene takes long to draw, and with fewer points
  // where that is not enough.
  turn() {
    this.view = '';
    if (!this.easing) this.easing = this.chooseEasing();
    this.ease(this.easing[0], this.easing[1]);
  }

  // Resolution and thinning with which the scene turns.
  chooseEasing() {
    const resolution = Math.min(1, Math.sqrt(kFrame / this.measure()));
    if (resolution >= kLeastResolution) return [resolution, 1];
    this.ease(kLeastResolution, 1);
    return [kLeastResolution, Math.min(kMostThinned, Math.max(1, Math.ceil(this.measure() / kFrame)))];
  }

  // Milliseconds that a drawing takes until it is there.
  measure() {
    const gl = this.renderer.getContext();
    const start = performance.now();
    this.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - start;
  }

  /** @param {number} every */
  ease(resolution, every) {
    if (resolution === this.resolution && every === this.every) return;
    Object.assign(this, { resolution, every });
    this.renderer.setPixelRatio(this.pixelRatio());
    this.thin(every);
    this.draw();
  }

  // What is shown has changed: it takes another time to draw.
  changeScene() {
    this.easing = undefined;
    ++this.changes;
    this.requestDraw();
  }

  // Screen pixels (of the layout) per page unit.
  pixelsPerUnit() {
    return (this.canvas.clientHeight / 2) * this.camera.zoom;
  }

  // What lies under a place of the canvas, pixels: the pane's number, and a ray.
  rayAt(x, y) {
    const panes = this.panes();
    const number = panes.findIndex(
      ({ left, top, width, height }) => x >= left && x < left + width && y >= top && y < top + height,
    );
    if (number < 0) return null;
    const { left, top, width, height } = panes[number];
    const at = [(2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height];
    this.camera.updateMatrixWorld();
    const origin = new Vector3(...at, -1).unproject(this.camera);
    const along = new Vector3(...at, 1).unproject(this.camera).sub(origin).normalize();
    return { number, ray: { origin, along } };
  }

  requestDraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
      this.changed();
    });
  }

  draw() {
    this.beforeDraw();
    const { clientHeight } = this.canvas;
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    this.panes().forEach(({ left, top, width, height }, i) => {
      const place = [left, clientHeight - top - height, width, height];
      this.renderer.setViewport(...place);
      this.renderer.setScissor(...place);
      this.renderer.render(this.scenes[i], this.camera);
    });
  }

  pressKey(event) {
    const orbit = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
    const zoom = { '+': 1.2, '=': 1.2, '-': 1 / 1.2 }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey || (!orbit && !zoom)) return;
    event.preventDefault();
    this.view = '';
    if (orbit) this.orbit(orbit[0] * kOrbitStep, orbit[1] * kOrbitStep);
    if (zoom) this.zoom(zoom);
  }

  // Turns the camera about the body; `elevation` keeps away from the poles, where "right" is undefined.
  orbit(azimuth, elevation) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyQuaternion(new Quaternion().setFromAxisAngle(this.camera.up, azimuth));
    const now = Math.PI / 2 - offset.angleTo(this.camera.up);
    const limit = Math.PI / 2 - 1e-5;
    const turn = Math.min(limit, Math.max(-limit, now + elevation)) - now;
    const axis = new Vector3().crossVectors(offset, this.camera.up).normalize();
    offset.applyQuaternion(new Quaternion().setFromAxisAngle(axis, turn));
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  zoom(factor) {
    this.camera.zoom = Math.min(
      this.controls.maxZoom,
      Math.max(this.controls.minZoom, this.camera.zoom * factor),
    );
    this.camera.updateProjectionMatrix();
    this.requestDraw();
  }
}
