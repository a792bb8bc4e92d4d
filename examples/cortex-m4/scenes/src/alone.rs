//! A scene alone in a file, to be weighed and searched for symbols.

/// Defines `scene`, the one routine of a file that holds nothing else: a sample of a scene, without
/// its constructor. With it come what every program must have: an answer to a panic, which the linker
/// drops if nothing panics, and an allocator, which stays out likewise.
#[macro_export]
macro_rules! alone {
    ($scene:ty, $gauges:literal) => {
        struct NoHeap;

        // SAFETY: it never gives memory out.
        unsafe impl core::alloc::GlobalAlloc for NoHeap {
            unsafe fn alloc(&self, _: core::alloc::Layout) -> *mut u8 {
                core::ptr::null_mut()
            }
            unsafe fn dealloc(&self, _: *mut u8, _: core::alloc::Layout) {}
        }

        #[global_allocator]
        static HEAP: NoHeap = NoHeap;

        #[panic_handler]
        fn on_panic(_: &core::panic::PanicInfo<'_>) -> ! {
            loop {}
        }

        /// One sample.
        #[unsafe(no_mangle)]
        pub extern "C" fn scene(
            scene: &mut $scene,
            volts: &$crate::Volts<$gauges>,
            answer: &mut <$scene as $crate::Scene<$gauges>>::Answer,
        ) {
            *answer = $crate::Scene::sense(scene, volts);
        }
    };
}
