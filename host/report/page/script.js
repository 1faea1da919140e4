'use strict';
// Moves the seam of every slider with its range input: pointer, touch and arrow keys alike.
for (const slider of document.querySelectorAll('.slider')) {
  const input = slider.querySelector('input');
  const move = () => slider.style.setProperty('--at', input.value + '%');
  input.addEventListener('input', move);
  slider.addEventListener('pointermove', event => {
    if (event.pointerType !== 'mouse') return;
    const box = slider.getBoundingClientRect();
    input.value = 100 * (event.clientX - box.left) / box.width;
    move();
  });
  move();
}
