// The script of a report page: the colours of the page, and the viewers. Every viewer draws with one WebGL context, since
// browsers give a page few of them, and only when something has changed; what is drawn is copied into the pane's canvas.
'use strict';
(() => {
  const root = document.documentElement;
  for (const choice of document.querySelectorAll('.themes input')) {
    choice.addEventListener('change', () => { root.dataset.theme = choice.value; });
  }
  const viewers = [...document.querySelectorAll('.viewer')];
  if (viewers.length === 0) return;

  /** Colours darkened by up to half where the surface turns away, as in the pictures: so the legend holds face-on. */
  const SHADER = {
    vertexShader: `
      varying vec3 vColour; varying vec3 vPlace;
      void main() {
        #if defined(USE_COLOR) || defined(USE_COLOR_ALPHA)
          vColour = color.rgb;
        #else
          vColour = vec3(-1.0);
        #endif
        vec4 place = modelViewMatrix * vec4(position, 1.0);
        vPlace = place.xyz;
        gl_Position = projectionMatrix * place;
      }`,
    fragmentShader: `
      uniform bool heat;
      varying vec3 vColour; varying vec3 vPlace;
      void main() {
        vec3 normal = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
        float facing = abs(dot(normal, normalize(vPlace)));
        bool coloured = heat && vColour.r >= 0.0;
        vec3 colour = coloured ? sRGBTransferOETF(vec4(vColour, 1.0)).rgb : vec3(0.80, 0.82, 0.85);
        gl_FragColor = vec4(colour * (coloured ? 0.5 + 0.5 * facing : 0.2 + 0.8 * facing), 1.0);
      }`,
  };
  /** Degrees up and down that the eye sees. */
  const FIELD = 28;
  /** Room around the original at first. */
  const MARGIN = 1.06;
  /** Pixels to drag for one turn, whatever the size of the views. */
  const TURN = 450;
  const KEY_TURN = Math.PI / 24;
  const KEY_ZOOM = 0.87;

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
  } catch {
    for (const canvas of document.querySelectorAll('.pane canvas')) {
      trouble(canvas, 'This browser shows no 3-D here (WebGL is off); the pictures below show the same.');
    }
    return;
  }

  function trouble(canvas, message) {
    const place = canvas.parentElement.querySelector('.trouble');
    place.textContent = message;
    place.hidden = false;
    canvas.hidden = true;
    canvas.setAttribute('aria-busy', 'false');
  }

  /** The bytes of the GLB in a script element: base64 of gzip. */
  async function unpacked(element) {
    const packed = Uint8Array.from(atob(element.textContent), (letter) => letter.charCodeAt(0));
    element.remove();
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Response(stream).arrayBuffer();
  }

  /** The direction that three numbers with blanks between them give. */
  function direction(text) {
    return new THREE.Vector3(...text.split(' ').map(Number)).normalize();
  }

  class Pane {
    constructor(figure, heat) {
      this.figure = figure;
      this.canvas = figure.querySelector('canvas');
      this.scene = new THREE.Scene();
      this.material = new THREE.ShaderMaterial({
        ...SHADER, uniforms: { heat }, vertexColors: true, side: THREE.DoubleSide,
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      });
      this.surfaces = [];
      this.edges = null;
    }

    async load() {
      try {
        const bytes = await unpacked(this.figure.querySelector('script'));
        const { scene } = await new THREE.GLTFLoader().parseAsync(bytes, '');
        scene.traverse((part) => { if (part.isMesh) this.surfaces.push(part); });
        for (const surface of this.surfaces) surface.material = this.material;
        this.scene.add(scene);
        this.scene.updateMatrixWorld();
        this.canvas.setAttribute('aria-busy', 'false');
      } catch (error) {
        trouble(this.canvas, `This model could not be shown: ${error.message}`);
      }
    }

    showEdges(wanted) {
      if (wanted && !this.edges) {
        const material = new THREE.LineBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.35 });
        this.edges = this.surfaces.map((surface) => {
          const lines = new THREE.LineSegments(new THREE.WireframeGeometry(surface.geometry), material);
          surface.add(lines);
          return lines;
        });
      }
      for (const lines of this.edges ?? []) lines.visible = wanted;
    }

    draw(camera) {
      const ratio = Math.min(devicePixelRatio, 2);
      const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((size) => Math.round(size * ratio));
      if (width === 0 || height === 0) return;
      Object.assign(this.canvas, { width, height });
      renderer.setSize(width, height, false);
      camera.aspect = width / height;
      // A narrow pane holds the unit sphere from side to side, a wide one from top to bottom.
      const half = Math.tan(FIELD * Math.PI / 360) * Math.max(1, height / width);
      camera.fov = Math.atan(half) * 360 / Math.PI;
      // As near as the model allows: depth has few digits to share.
      camera.near = Math.max(0.01, camera.position.length() - 1.5);
      camera.far = camera.position.length() + 3;
      camera.updateProjectionMatrix();
      renderer.render(this.scene, camera);
      this.canvas.getContext('2d').drawImage(renderer.domElement, 0, 0);
    }
  }

  class Viewer {
    constructor(element) {
      this.element = element;
      this.heat = { value: true };
      this.panes = [...element.querySelectorAll('.pane')].map((figure) => new Pane(figure, this.heat));
      this.up = direction(element.dataset.up);
      this.toward = direction(element.dataset.toward);
      this.camera = new THREE.PerspectiveCamera(FIELD);
      const panes = this.area = element.querySelector('.panes');
      this.turnUp(this.up);
      // Between the views and on their names a finger scrolls the page.
      panes.addEventListener('pointerdown', (event) => {
        if (event.target.tagName !== 'CANVAS') event.stopImmediatePropagation();
      }, { capture: true });
      // The wheel scrolls the page too, until a view has the focus.
      panes.addEventListener('wheel', (event) => {
        if (!panes.contains(document.activeElement) && !event.ctrlKey) event.stopImmediatePropagation();
      }, { capture: true });
      panes.addEventListener('pointerdown', (event) => { if (event.target.tabIndex === 0) event.target.focus(); });
      panes.addEventListener('keydown', (event) => this.key(event));
      element.addEventListener('change', ({ target }) => this.changed(target));
      element.querySelector('[name=reset]').addEventListener('click', () => this.controls.reset());
      new ResizeObserver(() => { this.pace(); this.redraw(); }).observe(panes);
    }

    /** Looks with `up` upward, from where the same turn takes the eye. */
    turnUp(up) {
      const turn = this.camera.quaternion.clone().setFromUnitVectors(this.up, up);
      this.camera.up.copy(up);
      this.camera.position.copy(this.toward).applyQuaternion(turn).multiplyScalar(1 / Math.sin(FIELD * Math.PI / 360));
      // Controls settle which way is up when they are made.
      this.controls?.dispose();
      this.controls = new THREE.OrbitControls(this.camera, this.area);
      this.area.style.touchAction = '';
      this.controls.minDistance = 0.2;
      this.controls.maxDistance = 20;
      this.controls.addEventListener('change', () => this.redraw());
      this.pace();
      this.fit();
    }

    /** Turns as far as the finger goes: the controls take all panes for one view. */
    pace() {
      const view = this.panes.find(({ figure }) => !figure.hidden).canvas;
      const { clientHeight } = this.area;
      this.controls.rotateSpeed = clientHeight / TURN;
      this.controls.panSpeed = clientHeight / Math.max(1, view.clientHeight);
    }

    /** Puts the eye where it just sees the whole original, which leaves corners of the unit sphere empty. */
    fit() {
      this.camera.updateMatrixWorld();
      const slope = Math.tan(FIELD * Math.PI / 360);
      const place = new THREE.Vector3();
      let missing = -Infinity;
      for (const { geometry, matrixWorld } of this.panes[0].surfaces) {
        const { position } = geometry.attributes;
        for (let vertex = 0; vertex < position.count; vertex += 1) {
          place.fromBufferAttribute(position, vertex).applyMatrix4(matrixWorld).applyMatrix4(this.camera.matrixWorldInverse);
          missing = Math.max(missing, Math.max(Math.abs(place.x), Math.abs(place.y)) / slope + place.z);
        }
      }
      if (missing > -Infinity) this.camera.position.setLength(MARGIN * (this.camera.position.length() + missing));
      this.controls.update();
      this.controls.saveState();
    }

    key(event) {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const actions = {
        ArrowLeft: () => this.controls.rotateLeft(KEY_TURN),
        ArrowRight: () => this.controls.rotateLeft(-KEY_TURN),
        ArrowUp: () => this.controls.rotateUp(KEY_TURN),
        ArrowDown: () => this.controls.rotateUp(-KEY_TURN),
        '+': () => this.controls.dollyIn(KEY_ZOOM),
        '=': () => this.controls.dollyIn(KEY_ZOOM),
        '-': () => this.controls.dollyOut(KEY_ZOOM),
        Home: () => this.controls.reset(),
      };
      if (!(event.key in actions)) return;
      event.preventDefault();
      actions[event.key]();
    }

    changed(input) {
      if (input.name === 'heat') this.heat.value = input.checked;
      if (input.name === 'edges') for (const pane of this.panes) pane.showEdges(input.checked);
      if (input.name.startsWith('show-')) {
        this.panes.forEach((pane, index) => { pane.figure.hidden = input.value !== '' && input.value !== String(index); });
      }
      if (input.name.startsWith('up-')) this.turnUp(direction(input.value));
      this.redraw();
    }

    redraw() {
      this.frame ??= requestAnimationFrame(() => {
        this.frame = undefined;
        for (const pane of this.panes) pane.draw(this.camera);
      });
    }
  }

  (async () => {
    for (const viewer of viewers.map((element) => new Viewer(element))) {
      for (const pane of viewer.panes) {
        await pane.load();
        if (pane === viewer.panes[0]) viewer.fit();
        viewer.redraw();
      }
    }
  })();
})();
