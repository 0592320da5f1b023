; A courier that brings what stands on its plate to an area. Of the state it needs (RobotAt area) and
; (On object trayarea1), which is what HIRES calls the plate of any robot.

(defdomain delivery (

(:operator (!move_base_param ?area ?motion_set)
  ((RobotAt ?from))
  ((RobotAt ?from))
  ((RobotAt ?area)))

(:operator (!imagine ?action . ?lists)
  ()
  ()
  ()
  0)

; How fast to drive is imagined; the second argument of the step stands in until the answer comes.
(:method (deliver ?object ?area)
  delivered
  ((RobotAt ?area))
  ()

  drive
  ((On ?object trayarea1) (preferred ?area ?set))
  ((!imagine !move_base_param (?area) (slow fast)) (!move_base_param ?area ?set)))

; What imagination found to fail is named with its exclamation mark or without.
(:- (preferred ?area fast) ((not (fails ?area fast))))
(:- (preferred ?area slow) ((fails ?area fast) (not (fails ?area slow))))
(:- (fails ?area ?set) ((imagined_failure move_base_param ?area ?set)))
(:- (fails ?area ?set) ((imagined_failure !move_base_param ?area ?set)))

))
