// The functions of FLINT that Carom calls, under their names: each goes on to where the function was found. Until FLINT is
// opened that is `unopened`, which opens it. FLINT_CALLS is written by cmake/flint_calls.cmake: a line "flint_call NAME" for each.
	.macro flint_call function
	.text
	.globl	\function
	.hidden	\function
	.type	\function, %function
\function:
	.cfi_startproc
#if defined __x86_64__
	jmp	*.Lfound_\function(%rip)
.Lunopened_\function:
	leaq	.Lfound_\function(%rip), %r11
	jmp	.Lunopened
#elif defined __aarch64__
	adrp	x16, .Lfound_\function
	ldr	x16, [x16, #:lo12:.Lfound_\function]
	br	x16
.Lunopened_\function:
	adrp	x16, .Lfound_\function
	add	x16, x16, #:lo12:.Lfound_\function
	b	.Lunopened
#endif
	.cfi_endproc
	.size	\function, . - \function
	.section .rodata
.Lname_\function:
	.asciz	"\function"
	.data
.Lfound_\function:
	.quad	.Lunopened_\function, .Lname_\function
	.endm

	.data
	.balign	16
	.globl	carom_flint_calls, carom_flint_calls_end
	.hidden	carom_flint_calls, carom_flint_calls_end
carom_flint_calls:
#include FLINT_CALLS
	.data
carom_flint_calls_end:

// The one table that inline functions of FLINT 2 read, where they know no instruction that counts leading zeros: the bits of
// each number below 128, and one.
#if defined __aarch64__
	.section .rodata
	.globl	__flint_clz_tab
	.hidden	__flint_clz_tab
	.type	__flint_clz_tab, %object
	.size	__flint_clz_tab, 128
__flint_clz_tab:
	.byte	1, 2
	.fill	2, 1, 3
	.fill	4, 1, 4
	.fill	8, 1, 5
	.fill	16, 1, 6
	.fill	32, 1, 7
	.fill	64, 1, 8
#endif

// Opens FLINT, keeping what may hold arguments, and begins anew.
	.text
.Lunopened:
#if defined __x86_64__
	pushq	%rbp
	movq	%rsp, %rbp
	pushq	%rdi
	pushq	%rsi
	pushq	%rdx
	pushq	%rcx
	pushq	%r8
	pushq	%r9
	pushq	%rax
	pushq	%r11
	subq	$64, %rsp
	movsd	%xmm0, (%rsp)
	movsd	%xmm1, 8(%rsp)
	movsd	%xmm2, 16(%rsp)
	movsd	%xmm3, 24(%rsp)
	movsd	%xmm4, 32(%rsp)
	movsd	%xmm5, 40(%rsp)
	movsd	%xmm6, 48(%rsp)
	movsd	%xmm7, 56(%rsp)
	call	carom_open_flint_or_end
	movsd	(%rsp), %xmm0
	movsd	8(%rsp), %xmm1
	movsd	16(%rsp), %xmm2
	movsd	24(%rsp), %xmm3
	movsd	32(%rsp), %xmm4
	movsd	40(%rsp), %xmm5
	movsd	48(%rsp), %xmm6
	movsd	56(%rsp), %xmm7
	addq	$64, %rsp
	popq	%r11
	popq	%rax
	popq	%r9
	popq	%r8
	popq	%rcx
	popq	%rdx
	popq	%rsi
	popq	%rdi
	popq	%rbp
	jmp	*(%r11)
#elif defined __aarch64__
	stp	x29, x30, [sp, #-160]!
	mov	x29, sp
	stp	x0, x1, [sp, #16]
	stp	x2, x3, [sp, #32]
	stp	x4, x5, [sp, #48]
	stp	x6, x7, [sp, #64]
	stp	x8, x16, [sp, #80]
	stp	d0, d1, [sp, #96]
	stp	d2, d3, [sp, #112]
	stp	d4, d5, [sp, #128]
	stp	d6, d7, [sp, #144]
	bl	carom_open_flint_or_end
	ldp	d6, d7, [sp, #144]
	ldp	d4, d5, [sp, #128]
	ldp	d2, d3, [sp, #112]
	ldp	d0, d1, [sp, #96]
	ldp	x8, x16, [sp, #80]
	ldp	x6, x7, [sp, #64]
	ldp	x4, x5, [sp, #48]
	ldp	x2, x3, [sp, #32]
	ldp	x0, x1, [sp, #16]
	ldp	x29, x30, [sp], #160
	ldr	x16, [x16]
	br	x16
#endif
	.section .note.GNU-stack, "", %progbits
