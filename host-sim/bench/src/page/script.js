// One scene at a time; the method under the pointer is found in every chart.
const scene = document.querySelector("#scene");
if (scene) {
  const show = () => {
    for (const section of document.querySelectorAll("[data-scene]")) section.hidden = section.dataset.scene !== scene.value;
  };
  scene.addEventListener("change", show);
  show();
}
const light = (method) => {
  for (const lit of document.querySelectorAll(".lit")) lit.classList.remove("lit");
  if (method) for (const one of document.querySelectorAll(`svg [data-method="${method}"]`)) one.classList.add("lit");
};
document.addEventListener("pointerover", (event) => light(event.target.closest("[data-method]")?.dataset.method));
