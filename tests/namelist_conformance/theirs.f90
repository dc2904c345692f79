! theirs.f90 -- reads the group &g of a file with the compiler's own namelist reader and prints what
! was set, one line an element: NAME(INDEX) VALUE. Exit code 1 after an error.
program theirs
  implicit none
  integer, parameter :: unset = -987654321
  integer(8) :: i, iv(5)
  real(8) :: x, xv(5)
  logical :: l, lv(3), l1, lv1(3)
  character(200) :: s, sv(3), path, message
  integer :: k, pass, status
  namelist /g/ i, iv, x, xv, l, lv, s, sv

  call get_command_argument(1, path)
  do pass = 1, 2  ! a logical was set if two passes from different values agree
    i = unset; iv = unset; x = unset; xv = unset; s = '<unset>'; sv = '<unset>'
    l = pass == 1; lv = pass == 1
    open(10, file=path, status='old', action='read')
    read(10, nml=g, iostat=status, iomsg=message)
    close(10)
    if (status /= 0) then
      write(0, '(a)') trim(message)
      call exit(1)
    end if
    if (pass == 1) then
      l1 = l; lv1 = lv
    end if
  end do
  if (i /= unset) print '(a,i0)', 'i(1) ', i
  do k = 1, 5
    if (iv(k) /= unset) print '(a,i0,a,i0)', 'iv(', k, ') ', iv(k)
  end do
  if (l .eqv. l1) print '(a,l1)', 'l(1) ', l
  do k = 1, 3
    if (lv(k) .eqv. lv1(k)) print '(a,i0,a,l1)', 'lv(', k, ') ', lv(k)
  end do
  if (s /= '<unset>') print '(3a)', 's(1) ', trim(s), '|'
  do k = 1, 3
    if (sv(k) /= '<unset>') print '(a,i0,3a)', 'sv(', k, ') ', trim(sv(k)), '|'
  end do
  if (.not. x == unset) print '(a,es25.17e3)', 'x(1) ', x
  do k = 1, 5
    if (.not. xv(k) == unset) print '(a,i0,a,es25.17e3)', 'xv(', k, ') ', xv(k)
  end do
end program theirs
