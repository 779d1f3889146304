// As much of a document as the modules under test ask for: elements with attributes, children and listeners.

class FakeElement extends EventTarget {
  constructor(name) {
    super();
    Object.assign(this, { name, attributes: {}, children: [], style: {}, value: '' });
  }

  setAttribute(name, value) {
    this.attributes[name] = String(value);
    if (name === 'value') this.value = String(value);
  }

  getAttribute(name) {
    return this.attributes[name] ?? null;
  }

  removeAttribute(name) {
    delete this.attributes[name];
  }

  focus() {}

  append(...children) {
    this.children.push(...children);
  }

  replaceChildren(...children) {
    this.children = children;
  }

  // The first of this kind below.
  querySelector(name) {
    for (const child of this.children) {
      if (child.name === name) return child;
      const found = child.querySelector?.(name);
      if (found) return found;
    }
    return null;
  }

  get textContent() {
    return this.children.map((child) => (typeof child === 'string' ? child : child.textContent)).join('');
  }

  set textContent(text) {
    this.children = [text];
  }

  // What the user types or drags it to.
  give(value, event) {
    this.value = String(value);
    this.dispatchEvent(new Event(event));
  }

  get valueAsNumber() {
    return this.value === '' ? NaN : Number(this.value);
  }
}

/**
 * An element of this kind.
 * @param {string} [name]
 */
export const fakeElement = (name = 'div') => new FakeElement(name);

/** Makes it the document of the modules. */
export function installDocument() {
  globalThis.document = Object.assign(new EventTarget(), { createElement: fakeElement });
}
