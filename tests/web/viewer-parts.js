// What the page of a report uses of three.js; scripts/vendor-viewer makes one file of it.
export { DoubleSide, LineBasicMaterial, LineSegments, Mesh, PerspectiveCamera, Scene, ShaderMaterial, Vector3, WebGLRenderer, WireframeGeometry } from 'three';
export { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
export { OrbitControls } from 'three/addons/controls/OrbitControls.js';
