// What the page uses of three.js r111, which has no types in Debian.
declare module 'three' {
  export class Vector3 {
    constructor(x?: number, y?: number, z?: number);
    x: number;
    y: number;
    z: number;
    set(...components: number[]): this;
    clone(): Vector3;
    copy(other: Vector3): this;
    add(other: Vector3): this;
    sub(other: Vector3): this;
    negate(): this;
    normalize(): this;
    multiplyScalar(factor: number): this;
    addScaledVector(other: Vector3, factor: number): this;
    cross(other: Vector3): this;
    crossVectors(a: Vector3, b: Vector3): this;
    dot(other: Vector3): number;
    angleTo(other: Vector3): number;
    lengthSq(): number;
    getComponent(index: number): number;
    applyMatrix3(matrix: Matrix3): this;
    applyQuaternion(turn: Quaternion): this;
    transformDirection(matrix: Matrix4): this;
    project(camera: Camera): this;
    unproject(camera: Camera): this;
    fromArray(array: ArrayLike<number>, offset?: number): this;
    toArray(): [number, number, number];
  }
  export class Vector4 {
    constructor(x?: number, y?: number, z?: number, w?: number);
    x: number;
    y: number;
    z: number;
    w: number;
    set(...components: number[]): this;
  }
  export class Matrix3 {
    set(...elements: number[]): this;
    setFromMatrix4(matrix: Matrix4): this;
    getInverse(matrix: Matrix3): this;
  }
  export class Matrix4 {
    clone(): Matrix4;
    setPosition(x: number, y: number, z: number): this;
  }
  export class Quaternion {
    setFromAxisAngle(axis: Vector3, angle: number): this;
  }
  export class Box3 {
    constructor(min: Vector3, max: Vector3);
    max: Vector3;
    applyMatrix4(matrix: Matrix4): this;
  }
  export class Color {
    constructor(colour?: number);
    set(colour: number): this;
    setRGB(...components: number[]): this;
  }
  export class BufferAttribute {
    constructor(array: ArrayLike<number>, itemSize: number, normalized?: boolean);
    array: Float32Array;
    count: number;
    needsUpdate: boolean;
  }
  export class BufferGeometry {
    setAttribute(name: string, attribute: BufferAttribute): this;
    getAttribute(name: string): BufferAttribute;
    setIndex(index: BufferAttribute | null): void;
    setDrawRange(start: number, count: number): void;
  }
  export class Object3D {
    visible: boolean;
    frustumCulled: boolean;
    renderOrder: number;
    children: any[];
    add(...objects: Object3D[]): this;
  }
  export class Group extends Object3D {}
  export class Scene extends Object3D {}
  export class Material {}
  export class ShaderMaterial extends Material {
    constructor(parameters: object);
    depthWrite: boolean;
  }
  export class LineBasicMaterial extends Material {
    constructor(parameters: object);
    color: Color;
  }
  class Drawn extends Object3D {
    constructor(geometry: BufferGeometry, material: Material);
    geometry: BufferGeometry;
    material: Material;
  }
  export class Points extends Drawn {}
  export class Mesh extends Drawn {}
  export class LineSegments extends Drawn {}
  export class Camera extends Object3D {
    position: Vector3;
    up: Vector3;
    matrixWorld: Matrix4;
    matrixWorldInverse: Matrix4;
    updateMatrixWorld(): void;
    getWorldDirection(target: Vector3): Vector3;
  }
  export class OrthographicCamera extends Camera {
    constructor(left: number, right: number, top: number, bottom: number, near: number, far: number);
    left: number;
    right: number;
    top: number;
    bottom: number;
    near: number;
    far: number;
    zoom: number;
    setViewOffset(width: number, height: number, x: number, y: number, w: number, h: number): void;
    updateProjectionMatrix(): void;
  }
  export class WebGLRenderer {
    constructor(parameters: object);
    autoClear: boolean;
    setPixelRatio(ratio: number): void;
    getPixelRatio(): number;
    setSize(width: number, height: number): void;
    setClearColor(colour: Color): void;
    setScissorTest(on: boolean): void;
    setViewport(...place: number[]): void;
    setScissor(...place: number[]): void;
    clear(): void;
    render(scene: Scene, camera: Camera): void;
    getContext(): WebGLRenderingContext;
  }
  export const BackSide: number;
  export const FrontSide: number;
  export const DoubleSide: number;
}

declare module 'orbit-controls' {
  import { Camera, Vector3 } from 'three';
  export class OrbitControls {
    constructor(camera: Camera, element: HTMLElement);
    enableKeys: boolean;
    screenSpacePanning: boolean;
    minZoom: number;
    maxZoom: number;
    target: Vector3;
    addEventListener(name: 'change' | 'start' | 'end', listener: () => void): void;
    update(): void;
  }
}
